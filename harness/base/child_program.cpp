// Children that run this program's own work to its end, or another program.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "harness/base/child_process.h"
#include "harness/base/clock.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"

namespace harness {
namespace {

// A child that ends with this process at the latest. SIGCHLD is blocked while this lives, so that
// nothing polls beside a measurement, and a wait returns as soon as the child ends or another
// signal comes.
class Child {
 public:
  // work: in the child, with the signals as they were; it must not return. Throws
  // std::runtime_error if no process can be made.
  explicit Child(const std::function<void()>& work) {
    sigemptyset(&child_ended_);
    sigaddset(&child_ended_, SIGCHLD);
    sigprocmask(SIG_BLOCK, &child_ended_, &before_);
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ < 0) {
      const int reason = errno;
      restore();
      throw std::runtime_error(std::string("no process: ") + std::strerror(reason));
    }
    if (process_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);  // it died before that
    restore();
    work();
    _exit(127);
  }
  ~Child() { restore(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Whether it has ended; if not, after at most a fifth of a second.
  bool ended() {
    if (waitpid(process_, &status_, WNOHANG) != 0) return true;
    constexpr timespec look_again{0, 200'000'000};
    sigtimedwait(&child_ended_, nullptr, &look_again);
    return false;
  }
  int status() const { return status_; }  // as of waitpid, once it has ended
  void send(int signal) const { kill(process_, signal); }

 private:
  void restore() const { sigprocmask(SIG_SETMASK, &before_, nullptr); }

  sigset_t child_ended_, before_;
  pid_t process_;
  int status_ = 0;
};

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

}  // namespace

int supervised(const std::function<int()>& work) {
  constexpr double patience = 0.7;  // s, for a child that was asked to end
  std::cout.flush();
  std::fflush(stdout);
  Child child([&] {
    const int code = work();
    std::cout.flush();
    std::fflush(stdout);
    _exit(code);  // no destructors: objects are the parent's
  });
  catch_interrupts();
  bool asked = false;
  for (Clock::time_point when; !child.ended();) {
    if (!interrupted()) continue;
    if (!asked) {
      asked = true;
      when = Clock::now();
      child.send(SIGTERM);
    } else if (since(when) > patience) {
      child.send(SIGKILL);
    }
  }
  remove_left_folders();
  const int status = child.status();
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  constexpr int interrupted_code = 130, crashed_code = 1;
  if (interrupted() || WTERMSIG(status) == SIGTERM) {
    std::cerr << "bench: interrupted\n";  // the child had no time to say so
    return interrupted_code;
  }
  if (WTERMSIG(status) == SIGPIPE) return 128 + SIGPIPE;  // nobody reads what it prints
  std::cerr << "bench: the program was ended by " << signal_text(WTERMSIG(status)) << '\n';
  return crashed_code;
}

std::string ProgramResult::last_error_line() const {
  std::string text = err.substr(0, err.find_last_not_of(" \n\r") + 1);
  text = text.substr(text.find_last_of("\n\r") + 1);
  if (!text.empty()) return text;
  return exit_code > 128 ? std::string("ended by ") + strsignal(exit_code - 128)
                         : "exit code " + std::to_string(exit_code);
}

ProgramResult run_program(const std::vector<std::string>& words, double timeout,
                          const std::string& input) {
  const TemporaryFile in = temporary_file(input), out = temporary_file(), err = temporary_file();
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  Child child([&] {  // nothing but system calls until it is the other program
    int descriptor = 0;
    for (FILE* file : {in.get(), out.get(), err.get()}) dup2(fileno(file), descriptor++);
    execvp(argv[0], argv.data());
  });
  ProgramResult result;
  for (const auto start = Clock::now(); !child.ended();) {
    result.timed_out = since(start) > timeout;
    if (result.timed_out || interrupted()) child.send(SIGKILL);
  }
  if (interrupted()) throw Interrupted();
  const int status = child.status();
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = contents(out.get());
  result.err = contents(err.get());
  return result;
}

}  // namespace harness
