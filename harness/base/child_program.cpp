#include "harness/base/child_program.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "harness/base/child_process.h"

namespace harness {
namespace {

// Files without a name instead of pipes: nothing can block, however much is written.
using TemporaryFile = std::unique_ptr<FILE, int (*)(FILE*)>;

TemporaryFile temporary_file(const std::string& text = "") {
  TemporaryFile file(std::tmpfile(), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
      std::fflush(file.get()) != 0)
    throw std::runtime_error(std::string("no temporary file: ") + std::strerror(errno));
  std::rewind(file.get());
  return file;
}

std::string contents(FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file))
    text.append(buffer.data(), n);
  return text;
}

// Between fork and exec, so nothing but system calls.
[[noreturn]] void become(char* const* argv, const std::array<FILE*, 3>& files,
                         const ChildWatch& watch, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it died before that
  for (int i = 0; i < 3; ++i) dup2(fileno(files[i]), i);
  watch.restore();
  execv(argv[0], argv);
  _exit(127);
}

}  // namespace

std::string ProgramResult::last_error_line() const {
  std::string text = err.substr(0, err.find_last_not_of(" \n\r") + 1);
  text = text.substr(text.find_last_of("\n\r") + 1);
  if (!text.empty()) return text;
  return exit_code > 128 ? std::string("ended by ") + strsignal(exit_code - 128)
                         : "exit code " + std::to_string(exit_code);
}

ProgramResult run_program(const std::vector<std::string>& words, const std::string& input,
                          double timeout, const std::function<bool()>& interrupted) {
  const TemporaryFile in = temporary_file(input), out = temporary_file(), err = temporary_file();
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  const ChildWatch watch;
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw std::runtime_error(std::string("no process: ") + std::strerror(errno));
  if (child == 0) become(argv.data(), {in.get(), out.get(), err.get()}, watch, parent);
  ProgramResult result;
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (!watch.ended(child, status)) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    result.timed_out = elapsed.count() > timeout;
    if (result.timed_out || interrupted()) kill(child, SIGKILL);
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = contents(out.get());
  result.err = contents(err.get());
  return result;
}

}  // namespace harness
