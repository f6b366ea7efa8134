// Children that misbehave end, and their parents do not. One process at a time takes times.
#include <sys/prctl.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <thread>

#include "harness/base/child_process.h"
#include "harness/base/timing_lock.h"
#include "support/refusal.h"

namespace harness {
namespace {

using End = ChildOutcome::End;

void sleep_for(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

TEST(ChildProcess, AnAnswerThatCannotBeReadIsHowItEnded) {
  for (const json& answer : {json({{"seconds", nullptr}}), json("a text"), json::object()}) {
    const std::string how = in_child(
        {}, [&answer](Heartbeat&) { return answer; },
        [](const json& read) { return std::to_string(read.at("seconds").get<double>()); },
        [](const ChildOutcome& outcome) {
          EXPECT_EQ(outcome.end, End::threw);
          return ending(outcome);
        });
    EXPECT_NE(how.find("cannot be read"), std::string::npos) << how;
  }
}

TEST(ChildProcess, ADescendantLeftBehindIsKilledAndDelaysNobody) {
  // This process adopts orphans: otherwise a killed one may stay a zombie for ever.
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const ChildOutcome outcome = run_in_child(
      [](Heartbeat& heartbeat) -> std::string {
        const pid_t own = fork();
        if (own == 0) {
          sleep_for(60000);  // with the pipe open
          _exit(0);
        }
        heartbeat.step = own;
        _exit(3);
      },
      {});
  EXPECT_EQ(outcome.end, End::exited);
  EXPECT_EQ(outcome.code, 3);
  const auto left = static_cast<pid_t>(outcome.step);
  ASSERT_GT(left, 0);
  int status = 0;
  ASSERT_EQ(waitpid(left, &status, 0), left);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
      << "its parent waited for the process that it left behind";
}

// The parent is stopped for longer than the time-out and its grace (0.8 s), but runs for much less.
TEST(ChildProcess, TimeInWhichTheParentWasStoppedIsNotTheChilds) {
  std::array<int, 2> begun{}, finish{};
  ASSERT_EQ(pipe(begun.data()) + pipe(finish.data()), 0);
  char c = 'x';
  const pid_t parent = fork();
  if (parent == 0) {
    const auto work = [&](Heartbeat&) {
      if (write(begun[1], &c, 1) != 1 || read(finish[0], &c, 1) != 1) _exit(1);
      return std::string("done");
    };
    const ChildOutcome outcome = run_in_child(work, {.timeout = 3});
    _exit(outcome.end == End::returned && outcome.text == "done" ? 0 : 1);
  }
  ASSERT_EQ(read(begun[0], &c, 1), 1);
  ASSERT_EQ(kill(parent, SIGSTOP), 0);
  sleep_for(4500);
  ASSERT_EQ(kill(parent, SIGCONT), 0);
  sleep_for(300);  // in which it looks at its child
  ASSERT_EQ(write(finish[1], &c, 1), 1);
  int status = 0;
  ASSERT_EQ(waitpid(parent, &status, 0), parent);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "it counted as timed out";
}

struct Lock : testing::Test {
  void SetUp() override { setenv("TMPDIR", ::testing::TempDir().c_str(), 1); }
};

// In a child, perhaps started under the lock: 0 if it gets it, 1 if the holder is named.
int try_in_child(bool started_under_it = false) {
  const pid_t child = fork();
  if (child == 0) {  // as after exec: the variable is inherited, the lock is not
    if (!started_under_it) unsetenv("INEXTENSIBLE_TIMING_LOCK");
    const std::string said = refusal_of([] { const TimingLock lock(false); });
    const bool named = said.find(std::to_string(getppid())) != std::string::npos;
    _exit(said.empty() ? 0 : named ? 1 : 2);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WEXITSTATUS(status);
}

TEST_F(Lock, IsHeldByOneProcessAndNotInTheWayOfProgramsStartedUnderIt) {
  {
    const TimingLock lock;
    EXPECT_EQ(try_in_child(), 1);
    EXPECT_EQ(try_in_child(true), 0);
    EXPECT_EQ(try_in_child(), 1) << "the child's end must not give up its parent's lock";
  }
  EXPECT_EQ(try_in_child(), 0);
}

TEST_F(Lock, EndsWithItsProcessThoughItsChildLives) {
  std::array<int, 2> held{};
  ASSERT_EQ(pipe(held.data()), 0);
  char c = 'x';
  const pid_t holder = fork();
  if (holder == 0) {
    setpgid(0, 0);
    const TimingLock lock;
    if (fork() > 0 && write(held[1], &c, 1) != 1) _exit(1);
    while (true) pause();  // both: the child outlives its parent
  }
  ASSERT_EQ(read(held[0], &c, 1), 1);
  kill(holder, SIGKILL);
  waitpid(holder, nullptr, 0);
  EXPECT_EQ(try_in_child(), 0);
  kill(-holder, SIGKILL);
}

}  // namespace
}  // namespace harness
