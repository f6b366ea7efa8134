// Every point in a child process of its own: a crash, a hang or want of memory is one point's
// status, with signal and step, and the sweep goes on.
#pragma once

#include "harness/run/sweep.h"

namespace harness {

// Runners that do what `inner` does, each call in a child. memory: bytes of address space a point
// may have, 0: no limit. A run of theirs throws Interrupted at once when the sweep is interrupted.
SweepRunners isolated(const SweepRunners& inner, double memory);

}  // namespace harness
