// Preloaded (LD_PRELOAD), it strikes at the n-th change (FAULT_AT) that a program or its children
// make to regular files: FAULT=kill kills the process, FAULT=full fills the disk from there on.
// FAULT_MARK names a file that exists once it has struck.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::atomic<long>* changes = nullptr;  // shared by the program and what it forks
long strike_at = 0;
bool kills = false;

__attribute__((constructor)) void begin() {
  const char* at = std::getenv("FAULT_AT");
  const char* fault = std::getenv("FAULT");
  if (!at || !fault) return;
  strike_at = std::atol(at);
  kills = std::strcmp(fault, "kill") == 0;
  void* place = mmap(nullptr, sizeof(std::atomic<long>), PROT_READ | PROT_WRITE,
                     MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (place != MAP_FAILED) changes = new (place) std::atomic<long>(0);
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

// Whether this change fails for lack of space. Does not return where the process is killed.
bool fails() {
  if (!changes) return false;
  const long now = ++*changes;
  if (kills ? now != strike_at : now < strike_at) return false;
  if (const char* mark = std::getenv("FAULT_MARK")) close(open(mark, O_CREAT | O_WRONLY, 0600));
  if (kills) kill(getpid(), SIGKILL);
  errno = ENOSPC;
  return true;
}

// Files without a name are memory, not on a disk.
bool is_regular(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink > 0;
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* data, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  return is_regular(file) && fails() ? -1 : real(file, data, size);
}

int fsync(int file) {
  static const auto real = next<int (*)(int)>("fsync");
  return is_regular(file) && fails() ? -1 : real(file);
}

int fdatasync(int file) {
  static const auto real = next<int (*)(int)>("fdatasync");
  return is_regular(file) && fails() ? -1 : real(file);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return fails() ? -1 : real(from, to);
}
}
