// Nothing is allocated inside a step after warm-up. Counted at malloc itself, so that Eigen's and
// the libraries' memory is seen too; UMFPACK, which allocates its numeric object by design, is not
// among the default solvers tested here.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "solvers/registry.h"
#include "support/param_name.h"
#include "support/scenes.h"

namespace {
std::atomic<long> allocations{0};
}

#if !defined(__SANITIZE_ADDRESS__)            // the sanitizer has a malloc of its own
extern "C" void* __libc_malloc(std::size_t);  // NOLINT(bugprone-reserved-identifier): glibc's own
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace inextensible {
namespace {

class NoAllocation : public ::testing::TestWithParam<const char*> {};

TEST_P(NoAllocation, InsideAStepAfterWarmUp) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "malloc belongs to the sanitizer";
#endif
  const Backend& row = *find_backend(GetParam());
  // Forces along the start of a step want short ones.
  const double step = row.direction == Direction::start ? 0.0005 : 0.002;
  for (const auto& scene : {harness::testing::build("chain", {{"n", 80}}),
                            harness::testing::build("drape", {{"n", 15}})}) {
    if (part_not_taken(row, *scene.problem)) continue;
    const auto stepper = make_stepper(GetParam(), scene.problem, {0.01, 1, {}});
    State state = scene.start;
    // Long enough for every method to have solved its first linear system.
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(stepper->advance(state, step));
    const long before = allocations;
    ASSERT_GT(before, 0) << "the counter does not count";
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(stepper->advance(state, step));
    EXPECT_EQ(allocations - before, 0) << scene.problem->vertices() << " vertices";
  }
}

INSTANTIATE_TEST_SUITE_P(All, NoAllocation, ::testing::ValuesIn(names::rows_that([](auto& row) {
                           return row.contestant;
                         })),
                         names::contestant_name);

}  // namespace
}  // namespace inextensible
