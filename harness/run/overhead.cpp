#include "harness/run/overhead.h"

#include <algorithm>

#include "harness/base/child_process.h"
#include "harness/judge/mechanics.h"
#include "harness/run/point_runner.h"

namespace harness {

double harness_seconds_per_step() {
  PointSpec spec;
  spec.scene = "chain";
  spec.scene_parameters = complete_parameters(*find_scene(spec.scene), {{"n", 2}});
  spec.solver = "null";
  spec.strain_limit = 1;
  constexpr int steps = 4096, rounds = 25;
  spec.step = spec.scene_parameters.at("duration") / steps;
  Heartbeat heartbeat;
  RunLimits limits;
  limits.interrupted = [] { return false; };
  limits.heartbeat = &heartbeat;
  const PointRunner runner(spec, limits);
  double with = 1e300, without = 1e300;
  for (int round = 0; round < rounds; ++round) {  // the least of each: what else runs only adds
    with = std::min(with, runner.seconds_per_step(runner.run({}, false, diverged_strain)));
    without = std::min(without, runner.bare_seconds_per_step());
  }
  return std::max(0.0, with - without);
}

}  // namespace harness
