// What long runs look at: the clock that everything here is timed with, and Ctrl-C as a flag.
#pragma once

#include <chrono>
#include <csignal>
#include <ctime>
#include <exception>
#include <optional>

namespace harness {

using Clock = std::chrono::steady_clock;

// s
inline double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The clock of a program that works for this thread (points/processes.cpp).
inline std::optional<clockid_t> helper_clock;

// Processor time of this thread, and of its helper, s. Costs a system call, a few hundred
// nanoseconds.
inline double thread_seconds() {
  const auto seconds_of = [](clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  return seconds_of(CLOCK_THREAD_CPUTIME_ID) + (helper_clock ? seconds_of(*helper_clock) : 0);
}

inline volatile std::sig_atomic_t interrupt_requested = 0;

// From here on SIGINT, SIGTERM and SIGHUP set a flag.
inline void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { interrupt_requested = 1; });
}
inline bool interrupted() { return interrupt_requested != 0; }

class Interrupted : public std::exception {};

}  // namespace harness
