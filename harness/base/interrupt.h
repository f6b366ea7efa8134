// Ctrl-C as a flag that loops poll.
#pragma once

#include <csignal>
#include <exception>

namespace harness {

inline volatile std::sig_atomic_t interrupt_requested = 0;

// From here on SIGINT, SIGTERM and SIGHUP set a flag.
inline void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { interrupt_requested = 1; });
}
inline bool interrupted() { return interrupt_requested != 0; }

class Interrupted : public std::exception {};

}  // namespace harness
