// A method that says that it is another one on a chain: bit for bit, for as long as a swing takes.
#include <gtest/gtest.h>

#include "harness/scenes/scene.h"
#include "solvers/registry.h"

namespace harness {
namespace {

TEST(SameOnChains, IsTheOtherMethodBitForBit) {
  const auto type = find_scene("chain");
  const Scene scene = type->build(complete_parameters(*type, {{"n", 40}}));
  int pairs = 0;
  for (const auto& backend : inextensible::backends()) {
    if (!*backend.same_on_chains) continue;
    ++pairs;
    for (const double strain_limit : {0.05, 0.001}) {
      SCOPED_TRACE(backend.name);
      const inextensible::BackendOptions options{strain_limit, 1, {}};
      const auto one = inextensible::make_stepper(backend.name, scene.problem, options);
      const auto other = inextensible::make_stepper(backend.same_on_chains, scene.problem, options);
      inextensible::State a = scene.start, b = scene.start;
      for (int step = 0; step < 100; ++step) {
        ASSERT_TRUE(one->advance(a, 0.005));
        ASSERT_TRUE(other->advance(b, 0.005));
        ASSERT_EQ(a.x, b.x) << "step " << step;
      }
      EXPECT_GT((a.x - scene.start.x).norm(), 0.1) << "nothing has moved";
    }
  }
  EXPECT_GE(pairs, 2);
}

}  // namespace
}  // namespace harness
