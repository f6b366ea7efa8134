// Ctrl-C as a flag that loops ask for.
#pragma once

#include <exception>

namespace harness {

// SIGINT, SIGTERM and SIGHUP become a flag from here on; whether one has come.
void catch_interrupts();
bool interrupted();

// What a loop throws that was asked to stop.
class Interrupted : public std::exception {};

}  // namespace harness
