// Friction of every kind of method against what statics and dynamics say of it.
#include <Eigen/Geometry>
#include <numbers>

#include "solvers/problem/triangle_collider.h"
#include "support/motion.h"
#include "support/param_name.h"

namespace inextensible {
namespace {

using Eigen::Vector3d, std::numbers::pi;

constexpr double gravity = 9.81, short_step = 1.0 / 400;

Settings stiff_enough(const char* solver) {
  return names::those_of(solver, {{"stiffness", 1e6}, {"direction_tolerance", 0.1}});
}

class Friction : public ::testing::TestWithParam<const char*> {};

// What is in contact, and the method that moves it.
struct Moving {
  void advance(int steps, double step_size = short_step) {
    for (int step = 0; step < steps; ++step) {
      const StepResult result = stepper->advance(state, step_size);
      ASSERT_TRUE(result) << result.detail << " at t = " << state.time;
    }
  }

  State state;
  std::unique_ptr<Stepper> stepper;
};

// Three links of a rope, down a slope, at rest.
struct OnSlope : Moving {
  OnSlope(const char* solver, double friction, double angle)
      : down(std::cos(angle), -std::sin(angle), 0) {
    state.x = down * Eigen::RowVector4d(0, 0.1, 0.2, 0.3);
    ProblemParts parts =
        testing::parts_at_rest(state.x, {{0, 1}, {1, 2}, {2, 3}}, {0.1, 0.3, 0.2, 0.1});
    parts.gravity = {0, -gravity, 0};
    const Vector3d normal(std::sin(angle), std::cos(angle), 0);
    parts.collider = std::make_shared<const testing::Ground>(normal, 0, friction);
    state.v.setZero(3, 4);
    stepper = make_stepper(solver, std::make_shared<const Problem>(std::move(parts)),
                           {1e-3, 1, stiff_enough(solver), &state});
  }
  Vector3d down;
};

TEST_P(Friction, HoldsARopeOnASlopeBelowItsAngleAndSlowsItAbove) {
  constexpr double angle = pi / 9;
  const double critical = std::tan(angle);
  OnSlope held(GetParam(), 1.02 * critical, angle), slides(GetParam(), 0.5 * critical, angle);
  const Positions start = held.state.x;
  held.advance(200);
  slides.advance(200);
  EXPECT_LT((held.state.x - start).cwiseAbs().maxCoeff(), 1e-6);
  const double a = gravity * std::sin(angle) * 0.5;  // half of it is friction's
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(slides.state.v.col(i).dot(slides.down), a * slides.state.time, 1e-3);
}

// In every stepper friction acts for the whole of a step: a rope that slides along itself at 1 m/s
// stops after v^2 / (2 mu g).
TEST(FrictionInEveryStepper, StopsASlidingRopeWhereCoulombSays) {
  constexpr double friction = 0.3, speed = 1;
  for (const char* solver : {"fast_projection", "fast_projection@bdf2", "fast_projection@midpoint",
                             "rattle", "implicit_springs@bdf2"}) {
    OnSlope rope(solver, friction, 0);
    rope.state.v.row(0).setConstant(speed);
    const Positions start = rope.state.x;
    rope.advance(200);
    const double way = speed * speed / (2 * friction * gravity);
    EXPECT_NEAR((rope.state.x - start).row(0).mean(), way, 0.01 * way) << solver;
    EXPECT_LT(rope.state.v.cwiseAbs().maxCoeff(), 1e-6) << solver;
  }
}

// A vertex is carried round where friction bears its centripetal acceleration, else flung off.
TEST(Turntable, HoldsWhatFrictionCanHold) {
  constexpr double rate = 4, radius = 0.5, needed = rate * rate * radius / gravity;
  const auto turn = [](double time) {
    return Eigen::AngleAxisd(rate * time, Vector3d::UnitY()).toRotationMatrix();
  };
  const auto after = [&](double friction) {
    ProblemParts parts;
    parts.mass = {0.3};
    parts.collider = std::make_shared<const testing::Ground>(Vector3d(0, 1, 0), 0, friction);
    parts.body_motion = [=](double time) { return Pose{turn(time), Vector3d::Zero()}; };
    Moving load;
    load.stepper =
        make_stepper("fast_projection", std::make_shared<const Problem>(parts), {0.01, 1});
    load.state = {Vector3d(radius, 0, 0), Vector3d(0, 0, -rate * radius), 0};  // with the table
    load.advance(64, 1.0 / 128);
    return load.state;
  };
  const State held = after(1.1 * needed), flung = after(0.5 * needed);
  EXPECT_LT((held.x.col(0) - turn(held.time) * Vector3d(radius, 0, 0)).norm(), 1e-12);
  EXPECT_GT(flung.x.col(0).norm(), 1.1 * radius);
}

// A post of `sides` facets each way round, along z, with the radius R to the middles of its facets.
TriangleMesh post(int sides, double radius) {
  TriangleMesh mesh;
  const double corner = radius / std::cos(pi / sides);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    for (const double z : {-1.0, 1.0})
      mesh.vertices.emplace_back(corner * std::cos(angle), corner * std::sin(angle), z);
  }
  for (int i = 0; i < sides; ++i) {
    const int a = 2 * i, b = a + 1, c = 2 * ((i + 1) % sides), d = c + 1;
    mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
    if (i == 0) continue;
    if (c != 0) mesh.triangles.insert(mesh.triangles.end(), {{0, c, a}, {1, b, d}});
  }
  return mesh;
}

// A rope over half of a post: a vertex on the middle of each upper facet, a load on either end.
struct OnPost : Moving {
  static constexpr int vertices = 32;
  static constexpr double radius = 0.1, mass = 0.01, light = 0.5, friction = 0.3;
  static constexpr double turn = pi / vertices;  // of the rope, at each vertex

  OnPost(const char* solver, double heavy) {
    state.x.resize(3, vertices + 2);
    std::vector<Edge> edges;
    for (int i = 0; i < vertices + 2; ++i) {
      const double angle = (std::clamp(i, 1, vertices) - 0.5) * turn;
      state.x.col(i) << radius * std::cos(angle), radius * std::sin(angle), 0;
      if (i > 0) edges.push_back({i - 1, i});
    }
    for (const int end : {0, vertices + 1}) state.x(1, end) -= 0.25;
    std::vector<double> masses(vertices + 2, mass);
    masses.front() = light;
    masses.back() = heavy;
    ProblemParts parts = testing::parts_at_rest(state.x, edges, masses);
    parts.gravity = {0, -gravity, 0};
    static const auto post_of_all =
        std::make_shared<const TriangleCollider>(post(2 * vertices, radius), friction);
    parts.collider = post_of_all;
    state.v.setZero(3, vertices + 2);
    stepper = make_stepper(solver, std::make_shared<const Problem>(std::move(parts)),
                           {1e-3, 1, stiff_enough(solver), &state});
  }

  // The load that just does not slip: each vertex turns the tension and bears its own weight,
  // n N = what tensions and weight press with, friction = mu N.
  static double heaviest() {
    double tension = light * gravity;
    for (int i = 0; i < vertices; ++i) {
      const double angle = (i + 0.5) * turn, weight = mass * gravity;
      const double c = std::cos(turn / 2), s = std::sin(turn / 2);
      // Along the tangent, towards the heavy side: (T' - T) c - weight cos(angle) = mu N; along the
      // normal: N = (T + T') s + weight sin(angle).
      tension =
          (tension * (c + friction * s) + weight * (std::cos(angle) + friction * std::sin(angle))) /
          (c - friction * s);
    }
    return tension / gravity;
  }
  double height() const { return state.x(1, vertices + 1); }  // of the heavy load
  double speed() const { return -state.v(1, vertices + 1); }  // downwards
};

// Euler (1769), Eytelwein (1808): the tensions on both sides differ by e^(mu theta) at most.
// Friction learns the tension in the first steps, in which the rope slips a little; then it brings
// the rope to rest, or lets it slide on.
TEST_P(Friction, OfARopeRoundAPostGrowsAsTheCapstanEquationSays) {
  OnPost held(GetParam(), 0.8 * OnPost::heaviest()), slips(GetParam(), 1.2 * OnPost::heaviest());
  held.advance(80);
  const double slipped = held.height();
  held.advance(40);
  EXPECT_GT(slipped, -0.25 - 0.015);
  EXPECT_NEAR(held.height(), slipped, 2e-3);  // 9 cm if nothing held it
  // 0.2 of the load pulls the whole.
  const double mass = 1.2 * OnPost::heaviest() + OnPost::light + OnPost::vertices * OnPost::mass;
  const double acceleration = 0.2 * OnPost::heaviest() * gravity / mass;
  slips.advance(20);
  const double before = slips.speed();
  slips.advance(40);
  EXPECT_NEAR(slips.speed() - before, acceleration * 40 * short_step,
              0.35 * acceleration * 40 * short_step);
}

INSTANTIATE_TEST_SUITE_P(Methods, Friction,
                         ::testing::Values("implicit_springs", "augmented_vbd", "admm",
                                           "gauss_seidel_colored", "shake", "icd",
                                           "fast_projection", "yarn_projection"),
                         names::contestant_name);

}  // namespace
}  // namespace inextensible
