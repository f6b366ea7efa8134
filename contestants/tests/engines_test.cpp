// The scenes of the other tests are what they say, without any engine.
#include <gtest/gtest.h>

#include "contestants/common/links.h"
#include "contestants/tests/known_scenes.h"

namespace engines {
namespace {

TEST(KnownScenes, LinksOfTheSwirlingChainKeepTheirLength) {
  const Scene scene = swirling_chain(9);
  EXPECT_LT(largest_strain(scene, scene.start), 1e-14);
  for (const auto& edge : scene.problem->edges()) {
    const Eigen::Vector3d d = scene.start.x.col(edge.b) - scene.start.x.col(edge.a);
    const Eigen::Vector3d dv = scene.start.v.col(edge.b) - scene.start.v.col(edge.a);
    EXPECT_NEAR(d.dot(dv), 0, 1e-15);
  }
}

}  // namespace
}  // namespace engines
