// A stopwatch for the phases of a step.
#pragma once

#include <chrono>

namespace inextensible {

class Stopwatch {
 public:
  // wanted = false: reads no clock, answers 0. A read takes tens of ns, a short step a few hundred.
  explicit Stopwatch(bool wanted) : wanted_(wanted) {
    if (wanted_) last_ = std::chrono::steady_clock::now();
  }

  // Seconds since construction or the last call.
  double operator()() {
    if (!wanted_) return 0;
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  bool wanted_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace inextensible
