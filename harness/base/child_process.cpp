#include "harness/base/child_process.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <new>

#include "harness/base/files.h"

namespace harness {
namespace {

constexpr double kill_after = 2;  // s after SIGTERM
// s. A longer gap between two looks: this process was stopped (Ctrl-Z); the child is not charged.
constexpr double stopped_for = 1;
constexpr char returned_mark = 'r', threw_mark = 'x';

double now() { return since({}); }

// A child that ends with this process at the latest. SIGCHLD is blocked meanwhile: a wait returns
// as soon as the child ends, and nothing polls beside a measurement.
class Child {
 public:
  // work: in the child, with the signals as they were; does not return. Throws std::runtime_error.
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
    if (getppid() != parent) _exit(127);  // the parent died first
    restore();
    work();
    _exit(127);
  }
  ~Child() { restore(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Whether it has ended; if not, after at most a fifth of a second.
  bool ended() {
    if (wait4(process_, &status_, WNOHANG, &usage_) != 0) return true;
    constexpr timespec look_again{0, 200'000'000};
    sigtimedwait(&child_ended_, nullptr, &look_again);
    return false;
  }
  int status() const { return status_; }  // as of wait4, once it has ended
  const rusage& usage() const { return usage_; }
  pid_t id() const { return process_; }

 private:
  void restore() const { sigprocmask(SIG_SETMASK, &before_, nullptr); }

  sigset_t child_ended_, before_;
  pid_t process_;
  int status_ = 0;
  rusage usage_{};
};

// Files without a name instead of pipes: nothing blocks, whoever still has the file open.
OpenFile nameless_file(const std::string& text = "") {
  OpenFile file(memfd_create("bench", MFD_CLOEXEC));
  if (!file || !write_whole(file.get(), text) || lseek(file.get(), 0, SEEK_SET) != 0)
    throw std::runtime_error(std::string("no temporary file: ") + std::strerror(errno));
  return file;
}

struct Unmap {
  void operator()(Heartbeat* p) const { munmap(p, sizeof(Heartbeat)); }
};

std::unique_ptr<Heartbeat, Unmap> shared_heartbeat() {
  void* place =
      mmap(nullptr, sizeof(Heartbeat), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED)
    throw std::runtime_error(std::string("no shared memory: ") + std::strerror(errno));
  return std::unique_ptr<Heartbeat, Unmap>(new (place) Heartbeat);
}

// Processes that the kernel has killed for lack of memory since it started; 0 if unknown.
long out_of_memory_kills() {
  std::ifstream statistics("/proc/vmstat");
  std::string key;
  for (long value = 0; statistics >> key >> value;)
    if (key == "oom_kill") return value;
  return 0;
}

void set_limit(int resource, double bytes) {
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  setrlimit(resource, &limit);
}

// Runs in the child. Nothing but its answer goes into the file.
void answer_in(const OpenFile& file, const std::function<std::string(Heartbeat&)>& work,
               Heartbeat& heartbeat, double memory) {
  setpgid(0, 0);  // so that what it starts can be found
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  send_output_to_error();
  set_limit(RLIMIT_CORE, 0);
  if (memory > 0) set_limit(RLIMIT_AS, memory);
  std::string text;
  try {
    text = returned_mark + work(heartbeat);
  } catch (const std::exception& error) {
    text = threw_mark + std::string(error.what());
  }
  const bool written = write_whole(file.get(), text);
  std::fflush(stdout);
  _exit(written ? 0 : 1);  // no destructors: the parent's objects are not ours
}

// Waits for the child, which was made after the time `last`, and ends it if it must not go on.
void attend(Child& child, double last, Heartbeat& heartbeat, const ChildLimits& limits,
            ChildOutcome& outcome) {
  const double grace = 0.5 + 0.1 * limits.timeout;
  double terminated = 0;
  const auto terminate = [&](ChildOutcome::End why) {
    outcome.end = why;
    terminated = now();
    kill(child.id(), SIGTERM);
  };
  while (!child.ended()) {
    const double away = now() - last;
    last += away;
    if (away > stopped_for) heartbeat.begin = heartbeat.begin + away;
    if (terminated > 0) {
      if (now() > terminated + kill_after) kill(child.id(), SIGKILL);
    } else if (limits.interrupted && limits.interrupted()) {
      terminate(ChildOutcome::End::interrupted);
    } else if (now() > heartbeat.begin + limits.timeout + grace) {
      terminate(ChildOutcome::End::timed_out);
    }
  }
}

// A SIGTERM of the child may be meant for the whole job, and reach this process a moment later.
bool interrupted_soon(const ChildLimits& limits) {
  for (int i = 0; i < 10 && limits.interrupted; ++i) {
    if (limits.interrupted()) return true;
    poll(nullptr, 0, 20);
  }
  return false;
}

}  // namespace

void Heartbeat::restart(int new_part) {
  begin = now();
  part = new_part;
}

std::string signal_text(int signal) {
  const char* name = sigabbrev_np(signal);
  return (name ? "SIG" + std::string(name) : "signal " + std::to_string(signal)) + " (" +
         strsignal(signal) + ")";
}

ChildOutcome run_in_child(const std::function<std::string(Heartbeat&)>& work,
                          const ChildLimits& limits) {
  // Attending interrupts only children that last; a series of short ones is interrupted here.
  ChildOutcome outcome;
  if (limits.interrupted && limits.interrupted()) {
    outcome.end = ChildOutcome::End::interrupted;
    return outcome;
  }
  const auto heartbeat = shared_heartbeat();
  heartbeat->restart();
  const OpenFile text = nameless_file();
  const long kills = out_of_memory_kills();
  std::cout.flush();  // or the child prints it as well
  std::fflush(stdout);
  const double before = now();  // this process may be stopped before it attends to the child
  Child child([&] { answer_in(text, work, *heartbeat, limits.memory); });
  setpgid(child.id(), child.id());  // whichever process runs first
  attend(child, before, *heartbeat, limits, outcome);
  kill(-child.id(), SIGKILL);  // what it has started and left behind
  const int status = child.status();
  outcome.peak_rss_bytes = 1024.0 * static_cast<double>(child.usage().ru_maxrss);
  outcome.text = read_whole(text.get());
  outcome.step = heartbeat->step;
  outcome.time = heartbeat->time;
  outcome.part = heartbeat->part;
  outcome.out_of_memory = out_of_memory_kills() > kills;
  outcome.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
  if (outcome.end != ChildOutcome::End::returned) return outcome;
  if (WIFSIGNALED(status)) {
    const bool for_all = outcome.code == SIGTERM && interrupted_soon(limits);
    outcome.end = for_all ? ChildOutcome::End::interrupted : ChildOutcome::End::killed;
  } else if (outcome.code != 0 || outcome.text.empty()) {
    outcome.end = ChildOutcome::End::exited;
  } else {
    if (outcome.text.front() == threw_mark) outcome.end = ChildOutcome::End::threw;
    outcome.text.erase(0, 1);
  }
  return outcome;
}

std::string ending(const ChildOutcome& outcome) {
  if (outcome.end == ChildOutcome::End::killed) return "killed by " + signal_text(outcome.code);
  if (outcome.end == ChildOutcome::End::exited)
    return "ended with exit code " + std::to_string(outcome.code);
  if (outcome.end == ChildOutcome::End::timed_out) return "a step did not end in time";
  return outcome.text;  // of the exception
}

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
      kill(child.id(), SIGTERM);
    } else if (since(when) > patience) {
      kill(child.id(), SIGKILL);
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
  const OpenFile in = nameless_file(input), out = nameless_file(), err = nameless_file();
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  Child child([&] {  // nothing but system calls until it is the other program
    int descriptor = 0;
    for (const int file : {in.get(), out.get(), err.get()}) dup2(file, descriptor++);
    execvp(argv[0], argv.data());
  });
  ProgramResult result;
  for (const auto start = Clock::now(); !child.ended();) {
    result.timed_out = since(start) > timeout;
    if (result.timed_out || interrupted()) kill(child.id(), SIGKILL);
  }
  if (interrupted()) throw Interrupted();
  const int status = child.status();
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = read_whole(out.get());
  result.err = read_whole(err.get());
  return result;
}

}  // namespace harness
