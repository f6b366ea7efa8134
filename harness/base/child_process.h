// Work done in a child process: what it does to memory, and how it ends, stays there.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "harness/base/clock.h"
#include "harness/base/json.h"

namespace harness {

// Shared by child and parent, so that the parent knows where a child is, or was when it died.
struct Heartbeat {
  std::atomic<double> begin{0};  // s, steady clock: when the part began that the time-out is for
  std::atomic<std::int64_t> step{-1};
  std::atomic<double> time{0};  // s, simulated
  std::atomic<int> part{0};     // of the work, in its own numbers

  void restart(int new_part = 0);  // begin = now
};

struct ChildLimits {
  double timeout = 60;                          // s from Heartbeat::begin on
  double memory = 0;                            // bytes of address space; 0: no limit
  std::function<bool()> interrupted = nullptr;  // polled a few times a second
};

struct ChildOutcome {
  enum class End { returned, threw, exited, killed, timed_out, interrupted };
  End end = End::returned;
  std::string text;  // what the work returned, or what() of what it threw
  int code = 0;      // exit code, or the signal that ended it
  double peak_rss_bytes = 0;
  bool out_of_memory = false;  // the kernel's out-of-memory killer was active
  std::int64_t step = -1;      // the heartbeat's last
  double time = 0;
  int part = 0;
};

// Runs work in a forked child. One that outlives its time-out, plus a little grace in which the
// work may end itself, gets SIGTERM, and SIGKILL two seconds later. It dies with its parent, and
// ignores SIGINT, which is meant for the parent. After an interruption no child is started. Throws
// std::runtime_error only if no child can be started. Not for programs with threads.
ChildOutcome run_in_child(const std::function<std::string(Heartbeat&)>& work,
                          const ChildLimits& limits);

// Runs the rest of the program, whose exit code it returns, in a child that an interruption ends
// within a second, wherever it is: it may end itself, and is killed where it does not (in a step
// that hangs, say). The exit code is 130 then, and 1 where the child crashes, which is said on
// stderr. Temporary folders of a child that was killed are removed.
int supervised(const std::function<int()>& work);

struct ProgramResult {
  int exit_code = 0;  // 128 + the signal's number if one ended it
  bool timed_out = false;
  std::string out, err;  // what it wrote

  std::string last_error_line() const;  // of err, or how it ended
};

// Runs another program to its end. words: the program as for a shell, then its arguments. It ends
// with this process at the latest. After `timeout` s of wall time, or an interruption, it is
// killed. Throws Interrupted, and std::runtime_error if no process can be made.
ProgramResult run_program(const std::vector<std::string>& words, double timeout,
                          const std::string& input = "");

// How a child ended that returned no result.
std::string ending(const ChildOutcome& outcome);

// "SIGSEGV (Segmentation fault)"
std::string signal_text(int signal);

// What `read` makes of the JSON that `work` returns in a child, or what `lost` makes of the way in
// which the child ended without it. JSON that cannot be read (a solver's counter that is not a
// number, say) counts as an exception of the child. Throws Interrupted.
template <class Read, class Lost>
auto in_child(const ChildLimits& limits, const std::function<json(Heartbeat&)>& work,
              const Read& read, const Lost& lost) {
  ChildOutcome child =
      run_in_child([&](Heartbeat& heartbeat) { return compact(work(heartbeat)); }, limits);
  if (child.end == ChildOutcome::End::interrupted) throw Interrupted();
  if (child.end == ChildOutcome::End::returned) {
    try {
      return read(json::parse(child.text));
    } catch (const json::exception& error) {
      child.end = ChildOutcome::End::threw;
      child.text =
          std::string("its result cannot be read, is a number not finite? ") + error.what();
    }
  }
  return lost(child);
}

}  // namespace harness
