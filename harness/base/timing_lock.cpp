#include "harness/base/timing_lock.h"

#include <fcntl.h>

#include <cstdlib>
#include <iostream>
#include <thread>

#include "harness/base/clock.h"
#include "harness/base/text.h"

namespace harness {
namespace {

// Names the process that holds the lock for the programs it starts.
constexpr const char* holder_variable = "INEXTENSIBLE_TIMING_LOCK";

}  // namespace

TimingLock::TimingLock(bool wait) {
  const std::string name = "inextensible-bench-" + std::to_string(getuid()) + ".lock",
                    path = std::filesystem::temp_directory_path() / name;
  file_ = OpenFile(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file_)
    throw UsageError("cannot open '" + path + "', the timing lock: " + std::strerror(errno) +
                     "; --untimed goes without");
  while (!try_lock(file_.get())) {
    if (errno != EACCES && errno != EAGAIN)
      throw UsageError("'" + path + "' cannot be locked: " + std::strerror(errno) +
                       "; --untimed goes without");
    const pid_t other = lock_holder(file_.get());
    const char* ours = std::getenv(holder_variable);
    if (ours && other > 0 && std::to_string(other) == ours) {
      file_ = OpenFile();
      return;
    }
    const std::string holder = other > 0 ? "process " + std::to_string(other) : "another process";
    if (interrupted()) throw Interrupted();
    if (!wait) throw UsageError(holder + " is timing runs on this machine");
    if (!waited_)
      std::cerr << "bench: waiting for " << holder << ", which is timing runs on this machine"
                << std::endl;
    waited_ = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  setenv(holder_variable, std::to_string(getpid()).c_str(), 1);
}

TimingLock::~TimingLock() {
  if (file_) unsetenv(holder_variable);
}

}  // namespace harness
