#include "harness/base/timing_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <thread>

#include "harness/base/errors.h"
#include "harness/base/interrupt.h"

namespace harness {
namespace {

// Tells programs that this one starts who holds the lock for them.
constexpr const char* holder_variable = "INEXTENSIBLE_TIMING_LOCK";

flock whole_file() {
  flock region{};
  region.l_type = F_WRLCK;
  region.l_whence = SEEK_SET;
  return region;
}

// The process that holds it; 0 if none does, or it cannot be seen from here.
pid_t holder(int file) {
  flock region = whole_file();
  return fcntl(file, F_GETLK, &region) == 0 && region.l_type != F_UNLCK ? region.l_pid : 0;
}

bool is_for_us(pid_t process) {
  const char* told = std::getenv(holder_variable);
  return told && process > 0 && std::to_string(process) == told;
}

}  // namespace

std::string timing_lock_path() {
  return (std::filesystem::temp_directory_path() /
          ("inextensible-bench-" + std::to_string(getuid()) + ".lock"))
      .string();
}

// POSIX locks, as the journal's: they end with the process, and forked children do not inherit
// them.
TimingLock::TimingLock(bool wait) {
  const std::string path = timing_lock_path();
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file_ < 0)
    throw UsageError("cannot open '" + path + "', which keeps two measurements apart: " +
                     std::strerror(errno) + "; --untimed goes without");
  flock region = whole_file();
  while (fcntl(file_, F_SETLK, &region) != 0) {
    const pid_t other = holder(file_);
    if (is_for_us(other)) {
      close(file_);
      file_ = -1;
      return;
    }
    const std::string who = other > 0 ? "process " + std::to_string(other) : "another process";
    if (!wait || interrupted()) {
      close(file_);
      if (interrupted()) throw Interrupted();
      throw UsageError(who + " is taking times on this machine");
    }
    if (!waited_)
      std::cerr << "bench: waiting for " << who << ", which is taking times on this machine"
                << std::endl;
    waited_ = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    region = whole_file();
  }
  setenv(holder_variable, std::to_string(getpid()).c_str(), 1);
}

TimingLock::~TimingLock() {
  if (file_ < 0) return;
  unsetenv(holder_variable);
  close(file_);
}

}  // namespace harness
