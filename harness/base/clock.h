// The clock that everything here is timed with.
#pragma once

#include <chrono>
#include <ctime>

namespace harness {

using Clock = std::chrono::steady_clock;

// s
inline double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Processor time of this thread, s. Costs a system call, a few hundred nanoseconds.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace harness
