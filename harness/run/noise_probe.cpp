#include "harness/run/noise_probe.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <string>

#include "harness/base/child_process.h"
#include "harness/base/clock.h"
#include "harness/judge/mechanics.h"
#include "harness/run/point_runner.h"
#include "harness/run/quiet_samples.h"

namespace harness {
namespace {

constexpr std::size_t doubles = 32768;

// A recurrence that waits for every result (a tridiagonal solve), over an array that fills the
// second-level cache.
double recurrence(std::vector<double>& data, int passes) {
  double carried = 1;
  for (int pass = 0; pass < passes; ++pass) {
    for (double& value : data) {
      carried = 0.5 * value + 0.25 * carried;
      value = 1 + 1e-9 * carried;
    }
  }
  return carried;
}

}  // namespace

double fixed_work() {
  static std::vector<double> data(doubles, 1.0);
  double carried = recurrence(data, 1);
  const auto start = Clock::now();
  carried += recurrence(data, 10);
  return since(start) + 0 * carried;
}

// Long enough, 50 ms or so, that a processor shared with others is seen: they get turns of some
// milliseconds.
void NoiseProbe::sample() {
  constexpr int runs = 50;
  work_();
  double sum = 0, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const double seconds = work_();
    sum += seconds;
    least = std::min(least, seconds);
  }
  samples_.push_back({since(start_), sum / runs});
  quiet_probe().renew(least);
}

void NoiseProbe::sample_if_due() {
  if (samples_.empty() || since(start_) - samples_.back().at >= every_) sample();
}

double NoiseProbe::spread() const {
  if (samples_.empty()) return 0;
  const auto [low, high] =
      std::minmax_element(samples_.begin(), samples_.end(),
                          [](const Sample& a, const Sample& b) { return a.seconds < b.seconds; });
  return high->seconds / low->seconds - 1;
}

nlohmann::json NoiseProbe::to_json() const {
  nlohmann::json at = nlohmann::json::array(), seconds = nlohmann::json::array();
  for (const Sample& s : samples_) {
    at.push_back(s.at);
    seconds.push_back(s.seconds);
  }
  return {{"at", at}, {"seconds", seconds}, {"spread", spread()}, {"noisy", noisy()}};
}

ProcessorTicks processor_ticks() {
  std::ifstream statistics("/proc/stat");
  std::string name;
  ProcessorTicks ticks;
  statistics >> name;  // cpu: user nice system idle iowait irq softirq steal; guests count as user
  std::array<double, 8> fields{};
  for (double& field : fields) statistics >> field;
  if (!statistics) return {};
  for (const double field : fields) ticks.all += field;
  ticks.stolen = fields[7];
  return ticks;
}

double stolen_share(const ProcessorTicks& before, const ProcessorTicks& after) {
  return after.all > before.all ? (after.stolen - before.stolen) / (after.all - before.all) : 0;
}

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
