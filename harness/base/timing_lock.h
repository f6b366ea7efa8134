// Only one program at a time measures times on a machine: two side by side slow each other down.
#pragma once

#include "harness/base/files.h"

namespace harness {

// One per user and machine, in the folder of temporary files (TMPDIR, or /tmp). Held from
// construction to destruction, and no longer than the process lives, however it ends.
// Forked children do not hold it; programs that the process starts may go on under it.
class TimingLock {
 public:
  // If another process holds it: waits, telling so, or throws UsageError. Throws Interrupted.
  explicit TimingLock(bool wait = true);
  ~TimingLock();

  bool waited() const { return waited_; }

 private:
  OpenFile file_;  // none: the program that started this one holds it
  bool waited_ = false;
};

}  // namespace harness
