#include "harness/base/standard_streams.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace harness {

void open_standard_streams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is this one. The other way round than it is used, so that use fails.
    const int opened = open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (opened != descriptor) _exit(1);  // no way to say why
  }
}

std::size_t output_columns(int file) {
  constexpr std::size_t usual = 120, least = 40;
  winsize size{};
  const bool known = ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? std::max<std::size_t>(size.ws_col, least) : usual;
}

void check_standard_output() {
  errno = 0;
  std::cout.flush();
  if (std::cout) return;
  throw FileError("standard output", "write to",
                  errno != 0 ? std::strerror(errno) : "it is closed or full");
}

// std::cout as well: it writes through stdout's buffer.
void send_output_to_error() {
  std::cout.flush();
  std::fflush(stdout);
  dup2(STDERR_FILENO, STDOUT_FILENO);
}

OutputToError::OutputToError() : output_(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)) {
  if (!output_)
    throw std::runtime_error(std::string("standard output: no descriptor left: ") +
                             std::strerror(errno));
  send_output_to_error();
}

OutputToError::~OutputToError() {
  std::cout.flush();
  std::fflush(stdout);
  dup2(output_.get(), STDOUT_FILENO);
}

}  // namespace harness
