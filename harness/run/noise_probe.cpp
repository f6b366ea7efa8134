#include "harness/run/noise_probe.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

#include "harness/base/clock.h"

namespace harness {
namespace {

// About 1 ms of what solvers do: a recurrence that waits for every result (a tridiagonal solve),
// and passes over an array that fills the second-level cache.
double kernel(std::vector<double>& data) {
  const auto start = Clock::now();
  double carried = 1;
  for (int pass = 0; pass < 10; ++pass) {
    for (double& value : data) {
      carried = 0.5 * value + 0.25 * carried;
      value = 1 + 1e-9 * carried;
    }
  }
  return since(start) + 0 * carried;
}

}  // namespace

// Long enough, 50 ms or so, that a processor shared with others is seen: they get turns of some
// milliseconds.
void NoiseProbe::sample() {
  constexpr std::size_t doubles = 32768;
  constexpr int runs = 50;
  std::vector<double> data(doubles, 1.0);
  kernel(data);
  double sum = 0;
  for (int i = 0; i < runs; ++i) sum += kernel(data);
  samples_.push_back({since(start_), sum / runs});
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

}  // namespace harness
