// How busy the machine is otherwise, from the time of a fixed piece of work: disturbed samples are
// taken again, and a sweep reports how noisy the machine was.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "harness/base/clock.h"

namespace harness {

// Takes about 0.1 ms for work like a solver's; s.
double fixed_work();

class QuietProbe {
 public:
  // A look that took more than this many times the shortest one was disturbed.
  static constexpr double disturbed_from = 1.1;
  static constexpr int most_retaken = 3;  // times that one sample is taken again

  using Work = std::function<double()>;  // does the work; s that it took
  explicit QuietProbe(Work work = fixed_work) : work_(std::move(work)) {}

  // Works once; s.
  double look();
  // Looks until one is undisturbed, or for `longest` seconds; the last one's time, s.
  double wait(double longest);
  // least: the least time of a long look, s. It replaces what was seen before the last long look,
  // since a processor may change its clock rate for good.
  void renew(double least) { least_ = std::min(std::exchange(renewed_, least), least); }
  bool disturbed(double seconds) const { return seconds > disturbed_from * least_; }

 private:
  Work work_;
  double least_ = std::numeric_limits<double>::infinity();    // s
  double renewed_ = std::numeric_limits<double>::infinity();  // s, by renew()
};

// The probe of this process and its children.
QuietProbe& quiet_probe();

// The first of take()'s samples with undisturbed looks before and after it; after most_retaken more
// the one whose worse look was the shortest. Also returns how many were dropped. again(sample): it
// may be replaced. longest_wait: s, for an undisturbed look before a try.
template <class Take, class Again>
auto take_quietly(QuietProbe& probe, Take take, Again again, double longest_wait) {
  using Sample = decltype(take());
  std::optional<Sample> calmest;
  double calm = std::numeric_limits<double>::infinity();
  double before = probe.wait(longest_wait);
  for (int dropped = 0;; ++dropped) {
    Sample sample = take();
    const double after = probe.look(), worse = std::max(before, after);
    const bool last =
        !again(sample) || !probe.disturbed(worse) || dropped == QuietProbe::most_retaken;
    if (!calmest || worse < calm || !again(sample)) {
      calmest = std::move(sample);
      calm = worse;
    }
    if (last) return std::pair(std::move(*calmest), dropped);
    before = probe.disturbed(after) ? probe.wait(longest_wait) : after;
  }
}

// Measures the noise every minute while a sweep runs.
class NoiseProbe {
 public:
  // The machine counts as noisy from this spread (largest over smallest time, less 1).
  static constexpr double noisy_from = 0.1;

  explicit NoiseProbe(QuietProbe::Work work = fixed_work) : work_(std::move(work)) {}

  void sample();
  void sample_if_due();

  double spread() const;
  bool noisy() const { return spread() > noisy_from; }
  nlohmann::json to_json() const;

 private:
  QuietProbe::Work work_;
  Clock::time_point start_ = Clock::now();
  std::vector<double> at_, seconds_;  // s since construction; of the work in a quieter quarter
};

}  // namespace harness
