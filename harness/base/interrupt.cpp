#include "harness/base/interrupt.h"

#include <csignal>

namespace harness {
namespace {

volatile std::sig_atomic_t interrupt_requested = 0;

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, [](int) { interrupt_requested = 1; });
  std::signal(SIGTERM, [](int) { interrupt_requested = 1; });
}

bool interrupted() { return interrupt_requested != 0; }

}  // namespace harness
