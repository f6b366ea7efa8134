#include "harness/run/machine_noise.h"

namespace harness {
namespace {

constexpr std::size_t doubles = 32768;
constexpr int first_looks = 10;

// A recurrence that waits for every result, over an array that fills the second-level cache.
double recurrence(std::vector<double>& data, int passes) {
  double carried = 1;
  for (int pass = 0; pass < passes; ++pass)
    for (double& value : data) {
      carried = 0.5 * value + 0.25 * carried;
      value = 1 + 1e-9 * carried;
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

double QuietProbe::look() {
  if (least_ == std::numeric_limits<double>::infinity())
    for (int i = 0; i < first_looks; ++i) least_ = std::min(least_, work_());
  const double seconds = work_();
  least_ = std::min(least_, seconds);
  return seconds;
}

QuietProbe& quiet_probe() {
  static QuietProbe probe;
  return probe;
}

// Takes about 50 ms, to notice other users of the processor, who get turns of a few milliseconds.
void NoiseProbe::sample() {
  constexpr int runs = 50;
  work_();
  double sum = 0, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const double seconds = work_();
    sum += seconds;
    least = std::min(least, seconds);
  }
  at_.push_back(since(start_));
  seconds_.push_back(sum / runs);
  quiet_probe().renew(least);
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
