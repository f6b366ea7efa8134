// Exact identities of every stepper, beside filters_test.cpp: closed-form single edges, invariance
// under rotation and under the unit of mass, momentum over whole runs, recovery after a refusal,
// and the failure configurations Q1, Q2 and Q4 of the paper's Figure 2.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "solvers/methods/fast_projection.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/registry.h"
#include "support/motion.h"
#include "support/param_name.h"
#include "support/random_graph.h"

namespace inextensible {
namespace {

using Eigen::Vector3d;
using testing::angular_momentum;
using testing::h;
using testing::linear_momentum;
using testing::moving_state;
using testing::Random;
using testing::random_graph;
using testing::random_mesh;
using testing::same_bits;
constexpr std::uint64_t examples = 8;

// Every backend that holds edges: those with a strain limit, implicit springs and the dense Newton.
std::vector<std::string> steppers() {
  std::vector<std::string> names;
  for (const Backend& backend : backends()) {
    if (std::string(backend.name) != "null") names.emplace_back(backend.name);
  }
  return names;
}

bool limits_strain(const std::string& name) {
  return find_backend(name)->strain_control == StrainControl::strain_limit;
}
bool is_elastic(const std::string& name) {
  return find_backend(name)->strain_control == StrainControl::stiffness;
}

// What a momentum is compared with: the sum of |m v|, which does not cancel.
double momentum_scale(const Problem& p, const Positions& v) {
  return v.colwise().norm().dot(Eigen::Map<const Eigen::VectorXd>(p.mass().data(), p.vertices()));
}

ProblemParts parts_of(const Problem& p) {
  ProblemParts parts;
  parts.mass = p.mass();
  parts.pinned = p.pinned();
  parts.edges = p.edges();
  parts.rest_length = p.rest_length();
  parts.gravity = p.gravity();
  return parts;
}

class Steppers : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Stepper> make(const std::shared_ptr<const Problem>& problem, double limit,
                                Settings settings = {}) const {
    return make_stepper(GetParam(), problem, {limit, 1, std::move(settings)});
  }
};

// Two masses, one edge of length 1. A correction along the edge's own direction keeps the centre of
// mass and the direction: x_a' = centre - w_a / (w_a + w_b) d / |d|. SHAKE's goes along the
// direction at the start, by the smaller root s of |d - s d_start| = 1.
TEST_P(Steppers, ShortenOneEdgeByTheClosedForm) {
  if (is_elastic(GetParam())) GTEST_SKIP() << "an elastic edge";
  if (GetParam() == "soft_step") GTEST_SKIP() << "corrects a part of an elongation";
  if (GetParam().ends_with("@midpoint")) GTEST_SKIP() << "the direction turns with the edge";
  for (std::uint64_t seed = 0; seed < 4 * examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    ProblemParts parts;
    parts.gravity.setZero();
    parts.mass = {testing::uniform(random, 0.01, 1), testing::uniform(random, 0.01, 1)};
    parts.edges = {{0, 1}};
    parts.rest_length = {1};
    if (seed % 4 == 0) parts.pinned = {static_cast<int>(seed / 4 % 2)};
    const auto problem = std::make_shared<const Problem>(parts);
    Positions start(3, 2), candidate(3, 2);
    start.col(0) =
        Vector3d::NullaryExpr([&](Eigen::Index) { return testing::uniform(random, -1, 1); });
    start.col(1) = start.col(0) + Vector3d::NullaryExpr([&](Eigen::Index) {
                                    return testing::uniform(random, -1, 1);
                                  }).normalized();
    candidate = start;
    for (int v = 0; v < 2; ++v) {
      if (problem->inverse_mass()[v] == 0) continue;
      for (int axis = 0; axis < 3; ++axis)
        candidate(axis, v) += testing::uniform(random, -0.2, 0.2);
    }
    const Vector3d d = candidate.col(1) - candidate.col(0);
    Vector3d correction;  // of d
    if (GetParam() == "shake" || GetParam() == "rattle") {
      const Vector3d e = start.col(1) - start.col(0);
      const double along = d.dot(e);
      correction = (std::sqrt(along * along - d.squaredNorm() + 1) - along) * e;
    } else {
      correction = d.normalized() - d;
    }
    const double wa = problem->inverse_mass()[0], wb = problem->inverse_mass()[1];
    Positions expected = candidate;
    expected.col(0) -= wa / (wa + wb) * correction;
    expected.col(1) += wb / (wa + wb) * correction;
    State state{start, (candidate - start) / h, 0};
    ASSERT_TRUE(make(problem, 1e-11)->advance(state, h));
    EXPECT_LT((state.x - expected).norm(), 1e-9);
  }
}

TEST_P(Steppers, CommuteWithRotationsAndTranslations) {
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 4, 2);
    State state = moving_state(random, mesh, 3);
    const Eigen::Matrix3d rotation =
        Eigen::Quaterniond(testing::uniform(random, -1, 1), testing::uniform(random, -1, 1),
                           testing::uniform(random, -1, 1), testing::uniform(random, -1, 1))
            .normalized()
            .toRotationMatrix();
    const Vector3d shift(3, -2, 5);
    State turned{(rotation * state.x).colwise() + shift, rotation * state.v, 0};
    const auto one = make(mesh.problem, 0.005), other = make(mesh.problem, 0.005);
    for (int step = 0; step < 3; ++step) {
      ASSERT_TRUE(one->advance(state, h));
      ASSERT_TRUE(other->advance(turned, h));
    }
    EXPECT_LT((turned.x - ((rotation * state.x).colwise() + shift)).norm(), 1e-9);
  }
}

// Only ratios of masses matter to a filter; springs need their stiffness in the same unit.
TEST_P(Steppers, DoNotDependOnTheUnitOfMass) {
  constexpr double factor = 1024;  // no rounding of its own in any precision
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 4, 2);
    ProblemParts parts = parts_of(*mesh.problem);
    for (double& mass : parts.mass) mass *= factor;
    Settings kilograms, grams;
    if (is_elastic(GetParam())) {
      kilograms["stiffness"] = 1e4;
      grams["stiffness"] = 1e4 * factor;
    }
    State state = moving_state(random, mesh, 3), heavy = state;
    const auto one = make(mesh.problem, 0.005, kilograms),
               other = make(std::make_shared<const Problem>(parts), 0.005, grams);
    for (int step = 0; step < 3; ++step) {
      ASSERT_TRUE(one->advance(state, h));
      ASSERT_TRUE(other->advance(heavy, h));
    }
    EXPECT_LT((heavy.x - state.x).norm(), 1e-9);
  }
}

// All forces act along edges in equal and opposite pairs. SHAKE's do no torque on x^n, so that its
// angular momentum x^n x m v^n is kept over the whole run too; end-of-step directions lose some, at
// first order in h.
TEST_P(Steppers, KeepMomentumOverARun) {
  if (!find_backend(GetParam())->conserves_momentum) GTEST_SKIP() << "only where it has converged";
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto graph = random_graph(random, 16, 10, 0, 0.01);
    const Problem& p = *graph.problem;
    State state = moving_state(random, graph, 0.5);
    const Vector3d linear = linear_momentum(p, state.v),
                   angular = angular_momentum(p, state.x, state.v);
    // Newton's residual; BDF2 takes differences of positions times 3 / 2, and of history.
    const double rounding = GetParam().ends_with("@bdf2") ? 3e-10 : 1e-10;
    const double scale = momentum_scale(p, state.v);
    const auto stepper = make(graph.problem, 0.001);
    for (int step = 0; step < 10; ++step) {
      ASSERT_TRUE(stepper->advance(state, 0.002));
      EXPECT_LT((linear_momentum(p, state.v) - linear).norm(), rounding * scale);
      if (GetParam() == "shake" || GetParam() == "rattle") {
        EXPECT_LT((angular_momentum(p, state.x, state.v) - angular).norm(), 1e-9 * scale);
      }
    }
  }
}

TEST_P(Steppers, LeaveAPermissibleCandidateBitForBit) {
  if (!limits_strain(GetParam())) GTEST_SKIP() << "no strain limit";
  for (const SettingInfo& setting : find_backend(GetParam())->settings) {
    if (setting.name == std::string("min_iterations") && std::get<double>(setting.initial) > 0)
      GTEST_SKIP() << "corrects every candidate";
  }
  if (GetParam().find('@') != std::string::npos)
    GTEST_SKIP() << "another candidate than the null filter's";
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 4, 1);
    State state = moving_state(random, mesh, 0.1), null_state = state;
    const auto stepper = make(mesh.problem, 0.05);
    const StepResult result = stepper->advance(state, h);
    ASSERT_TRUE(result);
    EXPECT_EQ(result.iterations, 0);
    ASSERT_TRUE(make_stepper("null", mesh.problem, {})->advance(null_state, h));
    EXPECT_TRUE(same_bits(state.x, null_state.x));
  }
}

// Claim C10: the constraint error of a step does not depend on the error it began with.
TEST_P(Steppers, CorrectAStretchedStartInOneStep) {
  if (!limits_strain(GetParam())) GTEST_SKIP() << "no strain limit";
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 5, 1);
    State state{testing::perturbed(random, mesh, 0.05), Positions::Zero(3, 20), 0};
    const EdgeConstraints edges(*mesh.problem, 0.001);
    ASSERT_GT(std::abs(edges.worst(state.x).strain), 0.03);
    ASSERT_TRUE(make(mesh.problem, 0.001)->advance(state, h));
    EXPECT_LE(std::abs(edges.worst(state.x).strain), 0.001);
  }
}

// Squares overflow, or positions nearly so. Local methods may even then find permissible positions;
// a refusal leaves the state untouched and nothing behind in the stepper: the next step is a
// fresh stepper's (but for Gauss-Seidel's random numbers, which have moved on).
TEST_P(Steppers, SurviveOverflowAndGoOnAsIfNothingHadBeen) {
  for (const double speed : {1e160, 1e300}) {
    for (std::uint64_t seed = 0; seed < examples; ++seed) {
      SCOPED_TRACE((speed < 1e200 ? "speed 1e160, seed " : "speed 1e300, seed ") +
                   std::to_string(seed));
      Random random(seed);
      const auto mesh = random_mesh(random, 4, 4, 1);
      const auto stepper = make(mesh.problem, 0.005);
      State state = moving_state(random, mesh, 3), fresh_state = state;
      State hopeless{state.x, state.v * speed, 2};
      const State before = hopeless;
      if (stepper->advance(hopeless, h)) {
        EXPECT_TRUE(hopeless.x.allFinite());
        if (limits_strain(GetParam())) {
          EXPECT_TRUE(EdgeConstraints(*mesh.problem, 0.005).permissible(hopeless.x));
        }
        continue;
      }
      EXPECT_TRUE(same_bits(hopeless.x, before.x));
      EXPECT_TRUE(same_bits(hopeless.v, before.v));
      EXPECT_EQ(hopeless.time, 2);
      EXPECT_EQ(stepper->work().rejected_steps, 1);
      EXPECT_EQ(stepper->work().steps, 0);
      ASSERT_TRUE(stepper->advance(state, h));
      ASSERT_TRUE(make(mesh.problem, 0.005)->advance(fresh_state, h));
      if (find_backend(GetParam())->method != std::string("gauss_seidel")) {
        EXPECT_TRUE(same_bits(state.x, fresh_state.x));
      }
    }
  }
}

// A triangle of rest lengths 1, 1 and 3 does not exist.
TEST_P(Steppers, RefuseAProblemWithoutSolutionAndNameAnEdge) {
  if (is_elastic(GetParam())) GTEST_SKIP() << "springs stretch instead";
  if (find_backend(GetParam())->strain_control == StrainControl::time_step)
    GTEST_SKIP() << "promises no limit";
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass = {1, 0.3, 2};
  parts.edges = {{0, 1}, {1, 2}, {2, 0}};
  parts.rest_length = {1, 1, 3};
  const auto problem = std::make_shared<const Problem>(parts);
  State state{Positions(3, 3), Positions::Zero(3, 3), 1};
  state.x << 0, 1, 0.5, 0, 0, 1, 0, 0.1, 0;
  const State before = state;
  Settings settings;
  if (limits_strain(GetParam())) settings["max_iterations"] = 500.0;
  const auto stepper = make(problem, 0.01, settings);
  const StepResult result = stepper->advance(state, h);
  ASSERT_FALSE(result);
  EXPECT_GE(result.worst_edge, 0);
  EXPECT_LT(result.worst_edge, 3);
  EXPECT_GT(std::abs(result.worst_strain), 0.01);
  EXPECT_TRUE(same_bits(state.x, before.x));
  EXPECT_TRUE(same_bits(state.v, before.v));
  EXPECT_EQ(state.time, before.time);
}

INSTANTIATE_TEST_SUITE_P(All, Steppers, ::testing::ValuesIn(steppers()), names::contestant_name);

// One iteration's forces go along the candidate's edges: no torque on x0, to the last digits.
TEST(FastProjection, OneIterationDoesNoTorqueOnTheCandidate) {
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 5, 0);
    const Positions candidate = testing::perturbed(random, mesh, 0.02);
    Positions x = candidate;
    WorkCounters work;
    ASSERT_EQ(FastProjection(*mesh.problem, {0.004}).apply(mesh.x, h, x, work).iterations, 1);
    const Positions dx = x - candidate;
    EXPECT_LT(angular_momentum(*mesh.problem, candidate, dx).norm(),
              1e-12 * momentum_scale(*mesh.problem, dx));
  }
}

// Figure 2 of the paper (claim C9). One step from `start` to `candidate`, whatever h.
struct Configuration {
  const char* name;
  ProblemParts parts;
  Positions start, candidate;
};

std::vector<Configuration> failure_configurations() {
  ProblemParts one;  // an edge of length 1 with one end pinned
  one.mass = {1, 1};
  one.pinned = {0};
  one.edges = {{0, 1}};
  one.rest_length = {1};
  one.gravity.setZero();
  ProblemParts two = one;  // a row between two pins, straight and a little too short
  two.mass = {1, 1, 1};
  two.pinned = {0, 2};
  two.edges = {{0, 1}, {1, 2}};
  two.rest_length = {1.02, 1.02};
  Positions start(3, 2), turned(3, 2), square(3, 2), row(3, 3), sagged(3, 3);
  start << 0, 1, 0, 0, 0, 0;
  turned << 0, 0.5, 0, 2, 0, 0;  // no multiple of (1, 0, 0) makes (0.5, 2, 0) a unit vector
  square << 0, 0, 0, 0.8, 0, 0;  // turned by 90 degrees: J(x0) W J(x^n)^T = 0
  row << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  sagged << 0, 1.01, 2, 0, -0.5, 0, 0, 0, 0;  // both gradients at x^n are along the row
  return {{"Q1", one, start, turned}, {"Q2", one, start, square}, {"Q4", two, row, sagged}};
}

// SHAKE's outcome in Q2 is only recorded: its first matrix is J(x^n) W J(x^n)^T (Barth et al.
// 1994), which is regular there although J(x0) W J(x^n)^T is not, and a solution exists.
TEST(FailureConfigurations, StopShakeAtAnyStepAndNeitherIcdNorFastProjection) {
  for (const Configuration& c : failure_configurations()) {
    const auto problem = std::make_shared<const Problem>(c.parts);
    for (const double step : {1e-1, 1e-3, 1e-5}) {
      SCOPED_TRACE(std::string(c.name) + ", h = " + std::to_string(step));
      for (const char* name : {"fast_projection", "icd", "shake"}) {
        State state{c.start, (c.candidate - c.start) / step, 0};
        const StepResult result = make_stepper(name, problem, {1e-6, 1, {}})->advance(state, step);
        if (std::string(name) != "shake") {
          EXPECT_TRUE(result) << name << ": " << result.detail;
        } else if (std::string(c.name) == "Q2") {
          RecordProperty("shake_in_Q2", to_string(result.status));
        } else {
          EXPECT_FALSE(result) << name;
        }
      }
    }
  }
}

}  // namespace
}  // namespace inextensible
