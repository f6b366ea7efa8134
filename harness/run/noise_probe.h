// A fixed piece of work, timed again and again while a sweep runs: if its time varies, so did the
// machine, and times measured meanwhile are to be taken with care.
#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace harness {

// About a millisecond of what solvers do; s. Data stay in the second-level cache, and are brought
// there before the clock starts.
double fixed_work();

class NoiseProbe {
 public:
  // Spread (largest over smallest time, less 1) from which on the machine counts as noisy.
  static constexpr double noisy_from = 0.1;

  using Work = std::function<double()>;  // does the work; s that it took

  // every: s between samples.
  explicit NoiseProbe(double every = 60, Work work = fixed_work)
      : every_(every), work_(std::move(work)) {}

  void sample();
  void sample_if_due();

  struct Sample {
    double at, seconds;  // s since construction; the kernel's mean time
  };
  const std::vector<Sample>& samples() const { return samples_; }
  double spread() const;
  bool noisy() const { return spread() > noisy_from; }
  // {"at": [...], "seconds": [...], "spread": x, "noisy": b}
  nlohmann::json to_json() const;

 private:
  double every_;
  Work work_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<Sample> samples_;
};

// Processor time of all processors since boot, in ticks; 0 where the system does not tell. Stolen:
// what a hypervisor gave to others.
struct ProcessorTicks {
  double stolen = 0, all = 0;
};
ProcessorTicks processor_ticks();
double stolen_share(const ProcessorTicks& before, const ProcessorTicks& after);  // 0 to 1

// What a timed step costs beyond the step, in seconds: the runner's time for steps of the solver
// `null` on two vertices, less the time of the same steps called one after the other.
double harness_seconds_per_step();

}  // namespace harness
