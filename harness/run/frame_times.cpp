#include "harness/run/frame_times.h"

#include <algorithm>
#include <cmath>

#include "harness/base/statistics.h"

namespace harness {
namespace {

constexpr double rounding = 1e-6;  // of a frame: times add up their steps

}  // namespace

FrameTimes::FrameTimes(double step) {
  for (const double rate : frame_rates) {
    if (step * rate <= 1 + rounding) films_.push_back({rate, {}});
  }
}

void FrameTimes::add(int steps, double step, double time, double seconds) {
  time_ = time;
  for (Film& film : films_) {
    for (int k = 0; k < steps; ++k) {
      const double end = (time - k * step) * film.rate;  // in frames
      const auto frame = static_cast<std::size_t>(std::max(0.0, std::ceil(end - rounding) - 1));
      if (film.seconds.size() <= frame) film.seconds.resize(frame + 1, 0.0);
      film.seconds[frame] += seconds / steps;
    }
  }
}

std::vector<FrameTime> FrameTimes::summary() const {
  std::vector<FrameTime> all;
  for (const Film& film : films_) {
    std::vector<double> whole = film.seconds;
    whole.resize(static_cast<std::size_t>(time_ * film.rate + rounding));
    if (whole.empty()) continue;
    all.push_back({film.rate, quantile(whole, 0.5), quantile(whole, 0.99), quantile(whole, 1)});
  }
  return all;
}

}  // namespace harness
