#include "contestants/tests/known_scenes.h"

namespace engines {
namespace {

const std::string solver = "engine_bullet";

TEST(Bullet, IsOfFirstOrder) { expect_first_order(solver); }
TEST(Bullet, TakesAndGivesStates) { expect_free_flight(solver); }
TEST(Bullet, TakesForces) { expect_spring(solver); }

// One pass a step from the pin down leaves link i of N the strain (N - i) g h^2 / l at rest.
TEST(Bullet, OnePassCarriesALoadByOneLink) {
  constexpr int links = 10;
  constexpr double h = 5e-4, l = 1.0 / links, fall = 9.81 * h * h;
  Scene scene = chain(links);
  scene.start.x.setZero();
  for (int i = 1; i <= links; ++i)
    scene.start.x(1, i) = scene.start.x(1, i - 1) - l - (links - i) * fall;
  const State after = run(solver, scene, h, 1);
  // The correction has no root: what is left is of second order in the strain.
  const double second = l * std::pow((2 * links - 2) * fall / l, 2);
  EXPECT_LT(distance(after.x, scene.start.x), links * second);
  EXPECT_LT(links * second, 0.2 * fall);  // a chain without that strain would rise by more
  EXPECT_NEAR(largest_strain(scene, after), (links - 1) * fall / l, 0.02 * links * fall / l);
}

// More passes strain less (NetSpinsDown has 300); another order is another motion.
TEST(Bullet, SettingsAreTaken) {
  const Scene scene = chain(10);
  const auto plain = run(solver, scene, 0.01, 20);
  const auto velocity_first = run(solver, scene, 0.01, 20, {{"velocity_iterations", 5.0}});
  EXPECT_LT(largest_strain(scene, velocity_first), 0.9 * largest_strain(scene, plain));
  const auto shuffled = run(solver, scene, 0.01, 20, {{"order", std::string("random")}});
  EXPECT_GT(distance(shuffled.x, plain.x), 1e-3);
}

// Corrections along directions at the end of a step slow a spinning body down:
// Omega(t) = Omega / sqrt(1 + 2 Omega^2 h t).
TEST(Bullet, NetSpinsDown) {
  constexpr double omega = 2 * std::numbers::pi, h = 1e-3;
  const Scene scene = spinning_net(5, omega);
  const State end = run(solver, scene, h, 500, {{"iterations", 300.0}});
  const double turning =
      angular_momentum(scene, end).y() / angular_momentum(scene, scene.start).y();
  EXPECT_NEAR(turning, 1 / std::sqrt(1 + 2 * omega * omega * h * 500 * h), 1e-3);
  EXPECT_LT(largest_strain(scene, end), 1e-4);
}

TEST(Bullet, RefusesWithoutTrace) {
  expect_overflow_refused(solver);
  const Scene scene = chain(5);
  expect_refusal_without_trace(solver, scene, scene.start, 1e-17);  // no step to Bullet
}

}  // namespace
}  // namespace engines
