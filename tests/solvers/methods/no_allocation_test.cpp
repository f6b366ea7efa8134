// Nothing is allocated inside a step after warm-up. Counted at malloc itself, so that Eigen's and
// the libraries' memory is seen too; UMFPACK, which allocates its numeric object by design, is not
// among the default solvers tested here.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "harness/scenes/scene.h"
#include "solvers/registry.h"
#include "support/param_name.h"

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

namespace harness {
namespace {

struct Case {
  const char* scene;
  int n;
  const char* solver;
  double step;
  const char* linear_solver = "auto";
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene << ' ' << c.n << ' ' << c.solver; }

class NoAllocation : public ::testing::TestWithParam<Case> {};

TEST_P(NoAllocation, InsideAStepAfterWarmUp) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "malloc belongs to the sanitizer";
#endif
  const auto [scene_name, n, solver, step, linear_solver] = GetParam();
  const auto found_type = find_scene(scene_name);
  const SceneType& type = *found_type;
  const Scene scene = type.build(complete_parameters(type, {{"n", n}}));
  inextensible::BackendOptions options{0.01, 1, {}};
  if (linear_solver != std::string("auto")) options.settings["linear_solver"] = linear_solver;
  const auto stepper = inextensible::make_stepper(solver, scene.problem, options);
  inextensible::State state = scene.start;
  // Long enough for every method to have solved its first linear system.
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(stepper->advance(state, step));
  const long before = allocations;
  ASSERT_GT(before, 0) << "the counter does not count";
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(stepper->advance(state, step));
  EXPECT_EQ(allocations - before, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Steppers, NoAllocation,
    ::testing::Values(
        Case{"chain", 80, "fast_projection", 0.005},
        Case{"chain", 80, "fast_projection@bdf2", 0.005},
        Case{"chain", 80, "gauss_seidel_colored@bdf2", 0.005},
        Case{"chain", 80, "implicit_springs@bdf2", 0.005},
        Case{"chain", 80, "gauss_seidel@midpoint", 0.005},
        Case{"drape", 15, "jacobi@midpoint", 0.005},
        Case{"drape", 15, "fast_projection@midpoint", 0.002},
        Case{"drape", 15, "augmented_vbd@bdf2", 0.005}, Case{"chain", 80, "rattle", 0.0005},
        Case{"drape", 15, "fast_projection@bdf2", 0.005}, Case{"drape", 15, "rattle", 0.001},
        Case{"chain", 80, "jacobi", 0.001}, Case{"chain", 80, "gauss_seidel", 0.001},
        Case{"chain", 80, "shake", 0.0005}, Case{"chain", 80, "icd", 0.005},
        Case{"chain", 80, "implicit_springs", 0.005}, Case{"drape", 15, "fast_projection", 0.005},
        Case{"drape", 15, "fast_projection", 0.005, "hybrid"}, Case{"drape", 15, "jacobi", 0.005},
        Case{"drape", 15, "gauss_seidel", 0.005}, Case{"drape", 15, "gauss_seidel_colored", 0.005},
        Case{"drape", 15, "yarn_projection", 0.005},
        Case{"drape", 15, "yarn_projection@bdf2", 0.005},
        Case{"drape", 15, "yarn_projection@midpoint", 0.005},
        Case{"drape", 15, "fast_projection_adaptive", 0.005},
        Case{"drape", 15, "fast_projection_adaptive@bdf2", 0.005},
        Case{"drape", 15, "shake", 0.001}, Case{"drape", 15, "icd", 0.005},
        Case{"drape", 15, "implicit_springs", 0.005},
        Case{"chain", 80, "vertex_block_descent", 0.005},
        Case{"drape", 15, "vertex_block_descent", 0.005}, Case{"chain", 80, "augmented_vbd", 0.005},
        Case{"drape", 15, "augmented_vbd", 0.005}, Case{"chain", 80, "admm", 0.005},
        Case{"drape", 15, "admm", 0.005}, Case{"chain", 80, "soft_step", 0.001}),
    [](const auto& i) {
      return std::string(i.param.scene) + "_" + inextensible::names::plain(i.param.solver) + "_" +
             i.param.linear_solver;
    });

}  // namespace
}  // namespace harness
