// Work done in a child process of its own: what it does to memory, how it ends and how long it
// takes stay there.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

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
  std::function<bool()> interrupted = nullptr;  // asked some times a second
};

struct ChildOutcome {
  enum class End { returned, threw, exited, killed, timed_out, interrupted };
  End end = End::returned;
  std::string text;  // what the work returned, or what() of what it threw
  int code = 0;      // exit code, or the signal that ended it
  double peak_rss_bytes = 0;
  bool out_of_memory = false;  // the kernel's out-of-memory killer was at work meanwhile
  std::int64_t step = -1;      // the heartbeat's last
  double time = 0;
  int part = 0;
};

// Runs work in a forked child. One that outlives its time-out (with a little grace: work that can,
// ends itself) gets SIGTERM, and SIGKILL two seconds later; it dies with its parent too, and
// ignores SIGINT, which is for the parent. After an interruption no child is made. Throws
// std::runtime_error only if no child can be made. Not for programs with threads.
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

// What became of a child that ended by itself or was ended, without a result.
std::string ending(const ChildOutcome& outcome);

// "SIGSEGV (Segmentation fault)"
std::string signal_text(int signal);

// What `read` makes of the answer; none where there is none. An answer that cannot be read (a
// solver's counter that is not a number, say) is how the child ended: outcome.end is then `threw`.
template <class Read>
auto answer(ChildOutcome& outcome, const Read& read)
    -> std::optional<std::invoke_result_t<Read, const nlohmann::json&>> {
  if (outcome.end != ChildOutcome::End::returned) return std::nullopt;
  try {
    return read(nlohmann::json::parse(outcome.text));
  } catch (const nlohmann::json::exception& error) {
    outcome.end = ChildOutcome::End::threw;
    outcome.text =
        std::string("its result cannot be read, is a number not finite? ") + error.what();
    return std::nullopt;
  }
}

}  // namespace harness
