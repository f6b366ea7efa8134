// Known answers: the formulas against published numbers, the scenes against the equations of
// motion, the readings against exact motion, and solvers against all of them.
#include <gtest/gtest.h>

#include <numbers>

#include "harness/answers/answer.h"
#include "harness/scenes/meshes.h"
#include "solvers/systems/constrained_acceleration.h"

namespace harness {
namespace {

constexpr double g = 9.81;

// What an answer's reading makes of the scene's exact motion.
double read_off_exact_motion(const KnownAnswer& answer, const AnswerScene& at, double step) {
  State state = at.scene.start;
  Motion motion(state, step);
  for (int i = 1; i <= std::lround(at.scene.duration / step); ++i) {
    state.time = i * step;
    state.x = at.type->exact(at.parameters, state.time);
    motion.take(state);
  }
  return answer.reading(at, motion);
}

const KnownAnswer& answer_named(const std::string& name) {
  return *std::ranges::find(known_answers(), name, &KnownAnswer::name);
}

// What an answer reads off positions at the end of a run.
double read_off(const char* answer, const AnswerScene& at, const Positions& x) {
  State state = at.scene.start;
  state.x = x;
  return answer_named(answer).reading(at, Motion(state, 1));
}

TEST(HangingFrequency, IsThatOfTheLiterature) {
  // Zeros of L_2 are 2 -+ sqrt 2: the double pendulum's.
  EXPECT_NEAR(hanging_frequency(2, 1, 1, 1), std::sqrt(2 - std::sqrt(2.0)), 1e-12);
  EXPECT_NEAR(hanging_frequency(2, 1, 1, 2), std::sqrt(2 + std::sqrt(2.0)), 1e-12);
  // 79 links of 1 m in all.
  EXPECT_NEAR(hanging_frequency(79, 1.0 / 79, g, 1), 3.7542, 1e-4);
  EXPECT_NEAR(hanging_frequency(79, 1.0 / 79, g, 2), 8.618, 1e-3);
  // Bernoulli's continuous chain: j_{0,k} / 2.
  EXPECT_NEAR(hanging_frequency(1000, 1e-3, 1, 1), 0.5 * 2.404825557695773, 1e-3);
}

TEST(FoldedChain, FallsInTheTimesOfCalkinAndMarch) {
  EXPECT_NEAR(folded_fall_time(0.2, 1, 1), 0.621042, 2e-6);
  EXPECT_NEAR(folded_fall_time(0.9, 1, 1), 1.177013, 2e-6);
  // The whole length, over free fall: the famous 85 %.
  EXPECT_NEAR(folded_fall_time(1, 1, 1) / std::sqrt(2.0), 0.847213, 2e-5);
}

// Where the exact motion is known, its second derivative is what forces and tensions make of it.
TEST(ScenesOfKnownMotion, ObeyTheEquationsOfMotion) {
  const struct {
    const char* scene;
    SceneParameters given;
    double tolerance;  // m/s^2
  } cases[] = {
      {"spinning_net", {{"n", 5}}, 1e-3},   {"baton", {{"n", 6}}, 1e-3},
      {"hoop", {{"n", 7}}, 1e-3},           {"hoop", {{"n", 8}}, 1e-3},
      {"catenary", {{"n", 9}}, 1e-6},       {"catenary", {{"n", 10}, {"slack", 3}}, 1e-6},
      {"whirling_chain", {{"n", 8}}, 1e-3}, {"whirling_chain", {{"n", 30}}, 1e-3},
      {"hanging_chain", {{"n", 9}}, 1e-3},  {"hanging_chain", {{"n", 9}, {"mode", 3}}, 1e-2}};
  for (const auto& [name, given, tolerance] : cases) {
    const AnswerScene built = answer_scene(name, given);
    const auto at = [&built](double t) { return built.type->exact(built.parameters, t); };
    const double dt = 1e-4;
    const Positions acceleration = (at(dt) - 2 * at(0) + at(-dt)) / (dt * dt);
    EXPECT_LT((inextensible::constrained_acceleration(*built.scene.problem, built.scene.start) -
               acceleration)
                  .cwiseAbs()
                  .maxCoeff(),
              tolerance)
        << name;
  }
}

TEST(Readings, OfExactMotionAreTheExactValues) {
  for (const KnownAnswer& answer : known_answers()) {
    if (answer.continuum || answer.needs_multipliers) continue;
    const AnswerScene at = answer.at();
    if (!at.type->exact) continue;
    EXPECT_NEAR(read_off_exact_motion(answer, at, answer.steps.back()), answer.exact,
                1e-5 * std::max(1.0, answer.exact))
        << answer.name;
  }
}

// A net put on a ball edge by edge, each corner where three spheres meet, along two great circles.
Positions net_on_ball(int n, double link, double radius) {
  Positions x(3, n * n);
  const int c = n / 2;
  const auto at = [&x, n](int i, int j) { return x.col(i * n + j); };
  const double turn = 2 * std::asin(0.5 * link / radius);
  for (int k = 0; k < n; ++k) {
    const double angle = (k - c) * turn;
    at(c, k) << radius * std::sin(angle), radius * std::cos(angle), 0;
    at(k, c) << 0, radius * std::cos(angle), radius * std::sin(angle);
  }
  for (const int down : {-1, 1})
    for (const int right : {-1, 1})
      for (int i = c + down; i >= 0 && i < n; i += down)
        for (int j = c + right; j >= 0 && j < n; j += right) {
          // On the ball and as far from a as from b: in the plane through the centre across a - b.
          // There the two points `link` from both are mirror images in the line from the centre
          // through the middle of a and b, and one is the corner across.
          const Eigen::Vector3d a = at(i - down, j), b = at(i, j - right);
          const Eigen::Vector3d across = at(i - down, j - right), line = (a + b).normalized();
          at(i, j) = 2 * line * line.dot(across) - across;
        }
  return x;
}

TEST(Fishnet, OfADiscreteNetComesCloserToTheAngleAsItIsRefined) {
  double coarse = 0;
  for (const int n : {41, 81}) {
    const double radius = 0.3;
    const AnswerScene at =
        answer_scene("drape", {{"n", n}, {"side", 0.5}, {"radius", radius}, {"subdivisions", 1}});
    const double link = square_link(at.parameters);
    Positions x = net_on_ball(n, link, radius);
    for (const auto& [a, b] : at.scene.problem->edges())
      ASSERT_NEAR((x.col(a) - x.col(b)).norm(), link, 1e-9);
    const double deviation = read_off("fishnet", at, x);
    EXPECT_LT(deviation, n == 81 ? 0.6 * coarse : 1);
    coarse = deviation;
    // Strained by a tenth along one yarn's direction, it is a net no more.
    x.row(0) *= 1.1;
    x.bottomRows<2>() *= 0.9;
    EXPECT_GT(read_off("fishnet", at, x), 3 * deviation);
  }
}

// The cone that a disc without warp and weft would be: flat for 0, a tube for pi/2.
TEST(DrapeCoefficient, OfConesIsThatOfTheirShadows) {
  const double radius = 0.15, table = 0.09, ring = radius * radius - table * table;
  const AnswerScene at = answer_scene("cusick", {{"n", 61}});
  for (const double slope : {0.0, 0.5, 1.0, 0.5 * std::numbers::pi}) {
    Positions x = at.scene.start.x;
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
      const double r = std::hypot(x(0, v), x(2, v));
      if (r <= table) continue;
      const double out = (table + (r - table) * std::cos(slope)) / r;
      x.col(v) << out * x(0, v), -(r - table) * std::sin(slope), out * x(2, v);
    }
    const double rim = table + (radius - table) * std::cos(slope);
    EXPECT_NEAR(read_off("drape_of_cotton", at, x), 100 * (rim * rim - table * table) / ring, 1.5)
        << slope;
  }
}

// The rows of one answer by one solver.
std::vector<AnswerRow> measured(const char* answer, const char* solver, double timeout = 20) {
  const auto plan = plan_answers(Pattern("answer", answer), Pattern("solver", solver));
  return run_answers(plan, timeout, {}).rows;
}

TEST(KnownAnswers, AreMetWithTheOrdersOfTheMethods) {
  const struct {
    const char *answer, *solver;
    double order;      // 0: not tested, as a chain of links is not a continuum
    double deviation;  // of the finest step; at most
  } cases[] = {{"baton_place", "fast_projection", 1, 0.1},
               {"baton_place", "rattle", 2, 1e-4},
               {"baton_rate", "fast_projection@bdf2", 2, 1e-3},
               {"swing_frequency", "rattle", 2, 1e-4},
               {"whirl_place", "rattle", 2, 1e-3},
               {"catenary_place", "fast_projection", 2, 1e-4},
               // The multipliers, found along the iterates' directions, tend to the tensions.
               {"catenary_tensions", "fast_projection", 0, 0.05},
               {"fold_fall_time", "rattle", 0, 0.02},
               {"whip_speed", "rattle", 0, 0.1}};
  for (const auto& [answer, solver, order, deviation] : cases) {
    const auto rows = measured(answer, solver);
    ASSERT_FALSE(rows.empty());
    EXPECT_LT(std::abs(rows.back().deviation), deviation) << answer << ", " << rows.back().detail;
    if (order == 0) continue;
    EXPECT_NEAR(rows.back().order, order, 0.3) << answer << ", " << solver;
  }
}

TEST(KnownAnswers, SayWhyThereIsNone) {
  const auto rows = measured("baton_place", "jacobi", 1e-9);  // s: no run is as fast
  ASSERT_EQ(rows.size(), answer_named("baton_place").steps.size());
  for (const AnswerRow& row : rows) {
    EXPECT_TRUE(std::isnan(row.value));
    EXPECT_NE(row.detail, "");
  }
}

}  // namespace
}  // namespace harness
