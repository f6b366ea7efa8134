// Locks on whole files by POSIX: they end with the process, however it ends, and forked children do
// not inherit them. Closing any descriptor of the file gives its lock up.
#pragma once

#include <sys/types.h>

namespace harness {

// Whether the lock is held now; does not wait.
bool try_lock(int file);
// The process that holds it; 0 if none does, or it cannot be seen from here.
pid_t lock_holder(int file);

}  // namespace harness
