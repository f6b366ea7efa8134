// A stopwatch for the phases of a step.
#pragma once

#include <chrono>

namespace inextensible {

class Lap {
 public:
  // Seconds since construction or the last call.
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace inextensible
