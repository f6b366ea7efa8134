// Two processes never hold it at once; it ends with its process; who is started under it goes on.
#include "harness/base/timing_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

#include "harness/base/errors.h"

namespace harness {
namespace {

class Lock : public testing::Test {
 protected:
  void SetUp() override { setenv("TMPDIR", ::testing::TempDir().c_str(), 1); }
};

// In a child, which may have been started under the lock: 0 if it gets the lock at once, 1 if it is
// refused and the holder named.
int try_in_child(bool started_under_it = false) {
  const pid_t child = fork();
  if (child == 0) {  // as after exec: the variable is inherited, the lock is not
    if (!started_under_it) unsetenv("INEXTENSIBLE_TIMING_LOCK");
    try {
      const TimingLock lock(false);
      _exit(0);
    } catch (const UsageError& error) {
      const bool named =
          std::string(error.what()).find(std::to_string(getppid())) != std::string::npos;
      _exit(named ? 1 : 2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WEXITSTATUS(status);
}

TEST_F(Lock, IsHeldByOneProcessAndNotInTheWayOfProgramsStartedUnderIt) {
  {
    const TimingLock lock;
    EXPECT_FALSE(lock.waited());
    EXPECT_EQ(try_in_child(), 1);
    EXPECT_EQ(try_in_child(true), 0);
    EXPECT_EQ(try_in_child(), 1) << "the child's end must not give up its parent's lock";
  }
  EXPECT_EQ(try_in_child(), 0);
}

TEST_F(Lock, EndsWithItsProcessThoughAChildOfThatLives) {
  std::array<int, 2> tell{}, stop{};
  ASSERT_EQ(pipe(tell.data()), 0);
  ASSERT_EQ(pipe(stop.data()), 0);
  const pid_t holder = fork();
  if (holder == 0) {
    const TimingLock lock;
    if (fork() == 0) {  // outlives its parent until told to stop
      char c = 0;
      close(stop[1]);
      _exit(static_cast<int>(read(stop[0], &c, 1)));
    }
    const char c = 'x';
    if (write(tell[1], &c, 1) != 1) _exit(1);
    pause();
  }
  char c = 0;
  ASSERT_EQ(read(tell[0], &c, 1), 1);
  kill(holder, SIGKILL);
  waitpid(holder, nullptr, 0);
  EXPECT_EQ(try_in_child(), 0);
  for (const int end : {tell[0], tell[1], stop[0], stop[1]}) close(end);
}

}  // namespace
}  // namespace harness
