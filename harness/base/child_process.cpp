#include "harness/base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>

#include "harness/base/clock.h"
#include "harness/base/files.h"
#include "harness/base/standard_streams.h"

namespace harness {
namespace {

constexpr int poll_interval = 50;  // ms
constexpr double kill_after = 2;   // s after SIGTERM
// s without a look at the child: this process did not run then (Ctrl-Z), which is not the child's
// time.
constexpr double stopped_for = 1;
constexpr char returned_mark = 'r', threw_mark = 'x';

double now() { return since({}); }

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(std::string("cannot run a point in a child process: ") + what + ": " +
                           std::strerror(errno));
}

struct Unmap {
  void operator()(Heartbeat* p) const { munmap(p, sizeof(Heartbeat)); }
};

std::unique_ptr<Heartbeat, Unmap> shared_heartbeat() {
  void* place =
      mmap(nullptr, sizeof(Heartbeat), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) fail("mmap");
  return std::unique_ptr<Heartbeat, Unmap>(new (place) Heartbeat);
}

// Processes that the kernel has killed for lack of memory, ever; 0 where it does not tell.
long out_of_memory_kills() {
  std::ifstream statistics("/proc/vmstat");
  std::string key;
  for (long value = 0; statistics >> key >> value;) {
    if (key == "oom_kill") return value;
  }
  return 0;
}

void set_limit(int resource, double bytes) {
  const rlimit limit{static_cast<rlim_t>(bytes), static_cast<rlim_t>(bytes)};
  setrlimit(resource, &limit);
}

[[noreturn]] void be_child(const std::function<std::string(Heartbeat&)>& work, Heartbeat& heartbeat,
                           double memory, pid_t parent, int pipe) {
  setpgid(0, 0);  // so that what it starts can be found
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before that
  send_output_to_error();             // its answer goes through the pipe alone
  set_limit(RLIMIT_CORE, 0);
  if (memory > 0) set_limit(RLIMIT_AS, memory);
  std::string text;
  try {
    text = returned_mark + work(heartbeat);
  } catch (const std::exception& error) {
    text = threw_mark + std::string(error.what());
  }
  write_whole(pipe, text);  // or the parent is gone
  std::fflush(stdout);
  _exit(0);  // no destructors: the parent's objects are not ours
}

bool has_ended(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == child;
}

// Reads until the child closes its end or ends (it may have children of its own that keep the pipe
// open), and sees to it that it does.
void attend(pid_t child, int pipe, Heartbeat& heartbeat, const ChildLimits& limits,
            ChildOutcome& outcome) {
  const double grace = 0.5 + 0.1 * limits.timeout;
  double terminated = 0;
  const auto terminate = [&](ChildOutcome::End why) {
    outcome.end = why;
    terminated = now();
    kill(child, SIGTERM);
  };
  std::array<char, 65536> buffer{};
  for (double last = heartbeat.begin;;) {
    // Asked first: what it wrote before it ended is in the pipe then, and poll sees it.
    const bool ended = has_ended(child);
    pollfd ready{pipe, POLLIN, 0};
    const int count_ready = poll(&ready, 1, ended ? 0 : poll_interval);  // -1: a signal
    const double away = now() - last;
    last += away;
    if (away > stopped_for) heartbeat.begin = heartbeat.begin + away;
    if (count_ready > 0) {
      const ssize_t count = read(pipe, buffer.data(), buffer.size());
      if (count == 0) return;
      if (count > 0) outcome.text.append(buffer.data(), count);
      continue;
    }
    if (ended && count_ready == 0) return;
    if (terminated > 0) {
      if (now() > terminated + kill_after) kill(child, SIGKILL);
    } else if (limits.interrupted && limits.interrupted()) {
      terminate(ChildOutcome::End::interrupted);
    } else if (now() > heartbeat.begin + limits.timeout + grace) {
      terminate(ChildOutcome::End::timed_out);
    }
  }
}

// A SIGTERM that ended the child may have been meant for the whole job, and reach this process a
// moment later.
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
  // While children are attended, only those that take longer than poll_interval are interrupted: a
  // series of short ones is here.
  ChildOutcome outcome;
  if (limits.interrupted && limits.interrupted()) {
    outcome.end = ChildOutcome::End::interrupted;
    return outcome;
  }
  const auto heartbeat = shared_heartbeat();
  heartbeat->restart();
  std::array<int, 2> pipe{};
  if (pipe2(pipe.data(), O_CLOEXEC) != 0) fail("pipe");
  OpenFile from_child(pipe[0]), to_parent(pipe[1]);
  const long kills = out_of_memory_kills();
  std::cout.flush();  // or the child prints it as well
  std::fflush(stdout);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    from_child = OpenFile();
    be_child(work, *heartbeat, limits.memory, parent, to_parent.get());
  }
  setpgid(child, child);  // whichever process runs first
  to_parent = OpenFile();
  attend(child, from_child.get(), *heartbeat, limits, outcome);
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  kill(-child, SIGKILL);  // what it has started and left behind
  outcome.peak_rss_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
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
  return outcome.text;  // of the exception
}

}  // namespace harness
