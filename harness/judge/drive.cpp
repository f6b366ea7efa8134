#include "harness/judge/drive.h"

#include "solvers/systems/constrained_acceleration.h"

namespace harness {

using inextensible::Backend;
using inextensible::State;

State start_from(const inextensible::Problem& problem, const State& state, const Backend& backend,
                 double h) {
  const bool half_step = backend.velocities == inextensible::Velocities::half_step;
  return half_step ? inextensible::start_half_step_back(problem, state, h) : state;
}

State start_of(const Scene& scene, const Backend& backend, double h) {
  return scene.staggered ? start_from(*scene.problem, scene.start, backend, h) : scene.start;
}

}  // namespace harness
