// Ctrl-C as a flag that loops ask for.
#pragma once

#include <csignal>
#include <exception>

namespace harness {

inline volatile std::sig_atomic_t interrupt_requested = 0;

// SIGINT, SIGTERM and SIGHUP become a flag from here on; whether one has come.
inline void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { interrupt_requested = 1; });
}
inline bool interrupted() { return interrupt_requested != 0; }

// What a loop throws that was asked to stop.
class Interrupted : public std::exception {};

}  // namespace harness
