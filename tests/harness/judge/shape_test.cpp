// The shape of a cloth against numbers by hand.
#include "harness/judge/shape.h"

#include <gtest/gtest.h>

#include "support/scenes.h"

namespace harness {
namespace {

TEST(Shape, OfAFlatSquareIsItsHeightAndItsArea) {
  const Scene scene = testing::build("drape", {{"n", 9}, {"subdivisions", 0}});
  Shape shape = shape_of(scene, scene.start.x);
  EXPECT_NEAR(shape.at("corner_height"), 0.251, 1e-12);
  EXPECT_NEAR(shape.at("potential_energy"), 0.251, 1e-12);
  EXPECT_NEAR(shape.at("shadow"), 1, 0.01);  // pixels
  EXPECT_EQ(shape.at("folds"), 0);
  inextensible::Positions folded = scene.start.x;
  folded.row(0) = folded.row(0).cwiseAbs();
  EXPECT_NEAR(shape_of(scene, folded).at("shadow"), 0.5, 0.01);
}

}  // namespace
}  // namespace harness
