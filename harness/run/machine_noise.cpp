#include "harness/run/machine_noise.h"

#include "harness/base/statistics.h"

namespace harness {
// Independent operations in the first-level cache: a program that shares the core's units, such as
// another virtual machine on the sibling hyperthread, doubles its time. A recurrence, which waits
// for its own results, would hardly notice, while solvers lose as much as this work does.
double fixed_work() {
  static std::array<double, 2048> data{};
  const auto start = Clock::now();
  for (int pass = 0; pass < 300; ++pass) {
    for (double& value : data) value = 0.5 * value + 0.5;
    asm volatile("" ::"r"(data.data()) : "memory");  // so that no pass is left out
  }
  return since(start);
}

double QuietProbe::look() {
  const double seconds = work_();
  least_ = std::min(least_, seconds);
  return seconds;
}

double QuietProbe::wait(double longest) {
  const auto start = Clock::now();
  double seconds = look();
  while (disturbed(seconds) && since(start) < longest) seconds = look();
  return seconds;
}

QuietProbe& quiet_probe() {
  static QuietProbe probe;
  return probe;
}

// Takes about half a second, longer than others use the core at a time.
void NoiseProbe::sample() {
  std::vector<double> looks(5000);
  for (double& seconds : looks) seconds = work_();
  at_.push_back(since(start_));
  seconds_.push_back(quantile(looks, 0.25));
  quiet_probe().renew(quantile(looks, 0));
}

void NoiseProbe::sample_if_due() {
  if (at_.empty() || since(start_) - at_.back() >= 60) sample();
}

double NoiseProbe::spread() const {
  if (seconds_.empty()) return 0;
  const auto [low, high] = std::ranges::minmax(seconds_);
  return high / low - 1;
}

nlohmann::json NoiseProbe::to_json() const {
  return {{"at", at_}, {"seconds", seconds_}, {"spread", spread()}, {"noisy", noisy()}};
}

}  // namespace harness
