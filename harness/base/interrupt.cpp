#include "harness/base/interrupt.h"

#include <csignal>
#include <initializer_list>

namespace harness {
namespace {

volatile std::sig_atomic_t interrupt_requested = 0;

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { interrupt_requested = 1; });
}

bool interrupted() { return interrupt_requested != 0; }

}  // namespace harness
