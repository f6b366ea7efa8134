#include "harness/base/file_lock.h"

#include <fcntl.h>
#include <unistd.h>

namespace harness {
namespace {

flock whole_file() {
  flock region{};
  region.l_type = F_WRLCK;
  region.l_whence = SEEK_SET;
  return region;
}

}  // namespace

bool try_lock(int file) {
  flock region = whole_file();
  return fcntl(file, F_SETLK, &region) == 0;
}

pid_t lock_holder(int file) {
  flock region = whole_file();
  return fcntl(file, F_GETLK, &region) == 0 && region.l_type != F_UNLCK ? region.l_pid : 0;
}

}  // namespace harness
