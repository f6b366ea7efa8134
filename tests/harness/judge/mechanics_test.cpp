// Strain, momentum and energy against figures found by hand.
#include "harness/judge/mechanics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::ProblemParts;
using inextensible::State;

// Three vertices of 1, 2 and 3 kg in a row, edges of 1 m and 2 m.
Scene row() {
  ProblemParts parts;
  parts.mass = {1, 2, 3};
  parts.edges = {{0, 1}, {1, 2}};
  parts.rest_length = {1, 2};
  parts.gravity = {0, -10, 0};
  Scene scene;
  scene.size = 4;
  scene.start.x.setZero(3, 3);
  scene.start.v.setZero(3, 3);
  scene.start.x.row(0) << 0, 1, 3;
  scene.problem = std::make_shared<const Problem>(std::move(parts));
  return scene;
}

TEST(Strain, OfEdgesThatAreTooLongAndTooShort) {
  const Scene scene = row();
  Positions x = scene.start.x;
  const auto expect = [&](double most, double stretch, std::size_t edge) {
    const StrainRange found = strain_range(*scene.problem, x);
    EXPECT_NEAR(found.most, most, 1e-15);
    EXPECT_NEAR(found.stretch, stretch, 1e-15);
    EXPECT_EQ(found.edge, edge);
  };
  EXPECT_EQ(strain_range(*scene.problem, x).most, 0);
  x(0, 2) = 2.5;  // the second edge: 1.5 m of 2 m
  expect(0.25, 0, 1);
  x(0, 0) = -0.5;  // the first: 1.5 m of 1 m
  expect(0.5, 0.5, 0);
  std::vector<double> strains;
  append_strains(*scene.problem, x, strains);
  EXPECT_EQ(strains, (std::vector<double>{0.5, 0.25}));
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    x(1, 2) = value;
    EXPECT_TRUE(std::isinf(strain_range(*scene.problem, x).most));
    EXPECT_EQ(strain_range(*scene.problem, x).edge, 1u);
  }
}

TEST(Momentum, OfATurningRow) {
  const Scene scene = row();
  State state = scene.start;
  EXPECT_EQ(linear_momentum(*scene.problem, state.v).norm(), 0);
  // The centre of mass is at (2 + 9) / 6 m; every vertex turns about it at 2 rad/s and moves with
  // (0, 0, 5) m/s.
  const double centre = 11.0 / 6;
  for (int i = 0; i < 3; ++i) state.v.col(i) << 0, 2 * (state.x(0, i) - centre), 5;
  EXPECT_LT((linear_momentum(*scene.problem, state.v) - Eigen::Vector3d(0, 0, 30)).norm(), 1e-13);
  double inertia = 0;
  for (int i = 0; i < 3; ++i) inertia += (i + 1) * std::pow(state.x(0, i) - centre, 2);
  EXPECT_LT((angular_momentum(*scene.problem, state) - Eigen::Vector3d(0, 0, 2 * inertia)).norm(),
            1e-13);
}

TEST(Energy, OfARowThatIsLiftedAndThrown) {
  const Scene scene = row();
  State state = scene.start;
  const double before = total_energy(*scene.problem, state);
  state.x.row(1).setConstant(2);  // 6 kg by 2 m at 10 m/s^2
  state.v.row(2).setConstant(3);
  EXPECT_NEAR(total_energy(*scene.problem, state) - before, 6 * 10 * 2 + 0.5 * 6 * 9, 1e-12);
  EXPECT_NEAR(energy_scale(scene), 6 * 10 * 4, 1e-12);
}

}  // namespace
}  // namespace harness
