// The clock that everything here is timed with.
#pragma once

#include <chrono>

namespace harness {

using Clock = std::chrono::steady_clock;

// s
inline double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace harness
