// What every velocity filter must hold, over all registered backends, and the theorems of the
// paper.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solvers/methods/fast_projection.h"
#include "solvers/methods/icd.h"
#include "solvers/registry.h"
#include "support/motion.h"
#include "support/param_name.h"

namespace inextensible {
namespace {

using testing::angular_momentum;
using testing::h;
using testing::linear_momentum;
using testing::moving_state;
using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;
using testing::same_bits;
constexpr int seeds = 8;

std::vector<std::string> filters() {
  std::vector<std::string> names;
  for (const Backend& backend : backends()) {
    if (backend.strain_control == StrainControl::strain_limit) names.emplace_back(backend.name);
  }
  names.emplace_back("dense_newton");
  return names;
}

class Filters : public ::testing::TestWithParam<std::string> {};

TEST_P(Filters, MeetTheLimitAndKeepPinnedVerticesBitForBit) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 4, 2);
    const auto stepper = make_stepper(GetParam(), mesh.problem, {0.005, seed, {}});
    State state = moving_state(random, mesh, 4);
    const EdgeConstraints edges(*mesh.problem, 0.005);
    for (int step = 0; step < 5; ++step) {
      ASSERT_TRUE(stepper->advance(state, h));
      EXPECT_LE(std::abs(edges.worst(state.x).strain), 0.005);
      for (const int v : mesh.problem->pinned()) {
        EXPECT_TRUE(same_bits(state.x.col(v), mesh.x.col(v)));
      }
    }
  }
}

// Start-of-step directions conserve angular momentum about start-of-step positions only: a SHAKE
// force does no torque on x^n, an end-of-step force none on x^{n+1}, and each method is held to its
// own.
TEST_P(Filters, ConserveLinearMomentumAndTheirAngularMomentum) {
  if (!find_backend(GetParam())->conserves_momentum) GTEST_SKIP() << "only where it has converged";
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 4, 0);
    const Problem& p = *mesh.problem;
    const auto stepper = make_stepper(GetParam(), mesh.problem, {0.005, seed, {}});
    State state = moving_state(random, mesh, 4);
    const Positions x0 = state.x + h * state.v;
    const State before = state;
    ASSERT_TRUE(stepper->advance(state, h));
    const double scale =
        (before.v.cwiseAbs() * Eigen::Map<const Eigen::VectorXd>(p.mass().data(), p.vertices()))
            .norm();
    EXPECT_LT((linear_momentum(p, state.v) - linear_momentum(p, before.v)).norm(), 1e-10 * scale);
    if (GetParam() == "shake") {
      EXPECT_LT(
          (angular_momentum(p, before.x, state.v) - angular_momentum(p, before.x, before.v)).norm(),
          1e-9 * scale);
    } else if (GetParam() == "icd" || GetParam() == "dense_newton") {
      const double direction =
          GetParam() == "icd" ? 0.1 * 0.005 / h : 1e-10;  // as far as F = 0 is solved
      EXPECT_LT(
          (angular_momentum(p, state.x, state.v) - angular_momentum(p, state.x, before.v)).norm(),
          direction * scale);
    } else {
      // Iterated directions: sums of pairwise central forces at intermediate positions, x0 at the
      // earliest; the defect is of the order of the correction times the displacement.
      const double correction = (state.x - x0).norm() / h;
      EXPECT_LT((angular_momentum(p, x0, state.v) - angular_momentum(p, x0, before.v)).norm(),
                correction * (state.x - x0).norm());
    }
  }
}

TEST_P(Filters, LeaveTheStateUntouchedWhenTheyRefuse) {
  Random random(11);
  const auto mesh = random_mesh(random, 4, 4, 1);
  BackendOptions options{1e-13, 1, {}};
  if (GetParam() != "dense_newton") options.settings["max_iterations"] = 1.0;
  const auto stepper = make_stepper(GetParam(), mesh.problem, options);
  State state = moving_state(random, mesh, GetParam() == "dense_newton" ? 1e300 : 10);
  state.time = 3;
  const State before = state;
  const StepResult result = stepper->advance(state, h);
  ASSERT_FALSE(result);
  EXPECT_STRNE(result.detail, "");
  EXPECT_TRUE(same_bits(state.x, before.x));
  EXPECT_TRUE(same_bits(state.v, before.v));
  EXPECT_EQ(state.time, before.time);
  EXPECT_EQ(stepper->work().rejected_steps, 1);
  EXPECT_EQ(stepper->work().steps, 0);
}

TEST_P(Filters, RepeatBitForBitWithTheirCounters) {
  Random random(12);
  const auto mesh = random_mesh(random, 5, 4, 1);
  const State start = moving_state(random, mesh, 4);
  std::vector<State> ends;
  std::vector<WorkCounters> work;
  for (int run = 0; run < 2; ++run) {
    const auto stepper = make_stepper(GetParam(), mesh.problem, {0.005, 42, {}});
    State state = start;
    for (int step = 0; step < 5; ++step) ASSERT_TRUE(stepper->advance(state, h));
    ends.push_back(state);
    work.push_back(stepper->work());
  }
  EXPECT_TRUE(same_bits(ends[0].x, ends[1].x));
  EXPECT_EQ(work[0], work[1]);
}

INSTANTIATE_TEST_SUITE_P(All, Filters, ::testing::ValuesIn(filters()), names::contestant_name);

// Section 4.3: "The first iteration of these methods is identical."
TEST(FastProjection, FirstIterationIsIcdsFirstNewtonIteration) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 4, 5, 2);
    const Positions candidate = testing::perturbed(random, mesh, 0.02);
    // The loosest limit that one iteration reaches: candidates are off by some 0.03, the first
    // iterate by its square.
    const double limit = 0.004;
    ASSERT_FALSE(EdgeConstraints(*mesh.problem, limit).permissible(candidate));
    WorkCounters work;
    Positions fast = candidate, icd = candidate;
    FastProjection::Settings exact{limit};
    exact.linear_solver = "multifrontal";
    FastProjection fast_projection(*mesh.problem, exact);
    Icd::Settings settings{limit};
    settings.direction_tolerance =
        1e3;  // stop as soon as the strain is permissible, as fast projection does
    Icd implicit_direction(*mesh.problem, settings);
    ASSERT_EQ(fast_projection.apply(mesh.x, h, fast, work).iterations, 1);
    ASSERT_EQ(implicit_direction.apply(mesh.x, h, icd, work).iterations, 1);
    EXPECT_LT((fast - icd).norm(), 1e-9 * (fast - candidate).norm());
    // And both are x0 - W J^T (J W J^T)^-1 C, densely.
    const Eigen::MatrixXd j = testing::dense_gradient(*mesh.problem, candidate);
    const Eigen::MatrixXd wjt =
        testing::inverse_masses3(*mesh.problem).asDiagonal() * j.transpose();
    Eigen::VectorXd c(mesh.problem->constraints());
    for (int k = 0; k < c.size(); ++k) {
      const auto [a, b] = mesh.problem->edges()[k];
      const double l = mesh.problem->rest_length()[k];
      c[k] = (candidate.col(b) - candidate.col(a)).squaredNorm() / l - l;
    }
    const Eigen::VectorXd dx = -wjt * (j * wjt).ldlt().solve(c);
    EXPECT_LT((fast - candidate - Eigen::Map<const Positions>(dx.data(), 3, fast.cols())).norm(),
              1e-10);
  }
}

// Theorem 1 and section 4.3, to first order: a candidate that is off the manifold by e is taken to
// within O(e^2) of the closest point, which ICD finds. Corrections of single edges along themselves
// keep to the span of W J^T, so that sweeps between projections change nothing about that order
// (Kaczmarz 1937: from x0 they end at the closest point of linear constraints). What is off by a
// part of its correction, however small, halves with e; this quarters.
TEST(FastProjection, PlainOrSmoothedIsTheClosestPointToFirstOrder) {
  constexpr double limit = 1e-9;  // C = 0 for all that matters here
  for (const int sweeps : {0, 30}) {
    SCOPED_TRACE("sweeps " + std::to_string(sweeps));
    double off[2] = {0, 0};
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(seed);
      const auto mesh = random_mesh(random, 8, 8, 2);
      const Positions displacement = testing::perturbed(random, mesh, 1) - mesh.x;
      for (const int halved : {0, 1}) {
        const Positions candidate = mesh.x + (halved ? 0.005 : 0.01) * displacement;
        Positions x = candidate, closest = candidate;
        WorkCounters work;
        FastProjection::Settings settings{limit};
        settings.smoothing_sweeps = sweeps;
        ASSERT_TRUE(FastProjection(*mesh.problem, settings).apply(mesh.x, h, x, work));
        EXPECT_EQ(work.edge_projections > 0, sweeps > 0);
        Icd::Settings implicit{limit};
        ASSERT_TRUE(Icd(*mesh.problem, implicit).apply(mesh.x, h, closest, work));
        off[halved] += (x - closest).norm();
      }
    }
    EXPECT_LT(off[1], 0.3 * off[0]);  // 1/4, and 1/2 for what is of first order
    EXPECT_GT(off[1], 1e3 * limit);   // what is measured is not the limit's slack
  }
}

// Where sweeps pay, they replace projections.
TEST(FastProjection, SmoothedTakesFewerProjections) {
  int projections = 0, smoothed_projections = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 12, 12, 2);
    const Positions candidate = testing::perturbed(random, mesh, 0.2);
    FastProjection::Settings settings{0.01};
    FastProjection plain(*mesh.problem, settings);
    settings.smoothing_sweeps = 30;
    FastProjection smoothed(*mesh.problem, settings);
    WorkCounters work, smoothed_work;
    Positions x = candidate, y = candidate;
    const StepResult plain_result = plain.apply(mesh.x, h, x, work);
    const StepResult smoothed_result = smoothed.apply(mesh.x, h, y, smoothed_work);
    ASSERT_TRUE(plain_result && smoothed_result);
    EXPECT_TRUE(EdgeConstraints(*mesh.problem, settings.strain_limit).permissible(y));
    EXPECT_EQ(work.edge_projections, 0);
    projections += plain_result.iterations;
    smoothed_projections += smoothed_result.iterations;
  }
  EXPECT_LT(smoothed_projections, 0.8 * projections);
}

// Theorem 1: ICD's solution extremizes the M-norm distance to the candidate over {C = 0}.
// Perturbations along the null space of J, pulled back onto the manifold, must not come closer.
TEST(Icd, SolutionIsTheClosestPointOfTheManifold) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 3, 4, 1);
    const Problem& p = *mesh.problem;
    const Positions candidate = testing::perturbed(random, mesh, 0.05);
    WorkCounters work;
    Positions icd = candidate, oracle = candidate;
    Icd::Settings settings{1e-10};
    ASSERT_TRUE(Icd(p, settings).apply(mesh.x, h, icd, work));
    ASSERT_TRUE(make_velocity_filter("dense_newton", p, {})->apply(mesh.x, h, oracle, work));
    EXPECT_LT((icd - oracle).norm(), 1e-7);

    const auto distance = [&](const Positions& x) {
      return (x - candidate)
          .colwise()
          .squaredNorm()
          .dot(Eigen::Map<const Eigen::VectorXd>(p.mass().data(), p.vertices()));
    };
    Eigen::MatrixXd free_j = testing::dense_gradient(p, icd);
    for (const int v : p.pinned()) free_j.middleCols(3 * v, 3).setZero();
    const Eigen::MatrixXd null_space = free_j.fullPivLu().kernel();
    FastProjection pull_back(p, {1e-13});
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::VectorXd weights = Eigen::VectorXd::NullaryExpr(
          null_space.cols(), [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
      Eigen::VectorXd direction = null_space * weights;
      for (const int v : p.pinned()) direction.segment<3>(3 * v).setZero();
      Positions moved = icd + 1e-3 / direction.norm() *
                                  Eigen::Map<const Positions>(direction.data(), 3, icd.cols());
      ASSERT_TRUE(pull_back.apply(icd, h, moved, work));
      EXPECT_GE(distance(moved), distance(icd) - 1e-11);
    }
  }
}

// An edge 30 % too long at a limit of 10 %, one correction after the other: with relaxation 1.5 its
// strain is 0.3, -0.15, 0.075; with 0.5 it is 0.3, 0.15, 0.075. The heavier end moves less.
TEST(GaussSeidel, TakesItsRelaxationTimesTheCorrection) {
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass = {1, 3};
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  const auto problem = std::make_shared<const Problem>(parts);
  for (const char* solver : {"gauss_seidel", "gauss_seidel_colored"}) {
    for (const double relaxation : {0.5, 1.5}) {
      SCOPED_TRACE(std::string(solver) + ", relaxation " + std::to_string(relaxation));
      const auto stepper = make_stepper(solver, problem, {0.1, 1, {{"relaxation", relaxation}}});
      State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
      state.x(0, 1) = 1.3;
      const StepResult result = stepper->advance(state, h);
      ASSERT_TRUE(result);
      EXPECT_EQ(result.iterations, 2);
      EXPECT_NEAR((state.x.col(1) - state.x.col(0)).norm(), 1.075, 1e-14);
      EXPECT_NEAR(state.x(0, 0), 0.75 * 0.225, 1e-14);
    }
  }
}

// An edge far beyond the limit, iterated to the end: what is left of C is `target` of what is
// permissible. One within the target stays where it is.
TEST(ProjectionMethods, BringEdgesToTheirTarget) {
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass = {1, 3};
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  const auto problem = std::make_shared<const Problem>(parts);
  const double limit = 0.1, target = 0.5;
  for (const char* solver : {"fast_projection", "shake", "icd"}) {
    SCOPED_TRACE(solver);
    const auto stepper =
        make_stepper(solver, problem, {limit, 1, {{"target", target}, {"min_iterations", 40.0}}});
    const auto length_from = [&](double length) {
      State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
      state.x(0, 1) = length;
      EXPECT_TRUE(stepper->advance(state, h));
      return (state.x.col(1) - state.x.col(0)).norm();
    };
    EXPECT_NEAR(length_from(1.3), std::sqrt(1 + target * (1.1 * 1.1 - 1)), 1e-12);
    // C is convex: from below Newton's first step leads beyond the target, and is the last one.
    const double wanted = 1 + target * (0.9 * 0.9 - 1);  // length squared
    EXPECT_NEAR(length_from(0.8), (0.8 * 0.8 + wanted) / (2 * 0.8), 1e-8);
  }
  for (const char* solver : {"fast_projection", "shake"}) {
    const auto stepper =
        make_stepper(solver, problem, {limit, 1, {{"target", target}, {"min_iterations", 1.0}}});
    State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
    state.x(0, 1) = 1.05;
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_EQ(state.x(0, 1), 1.05);
    EXPECT_EQ(stepper->work().factorizations, 0);
  }
}

TEST(FastProjection, SweepsBeforeReplaceProjections) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 8, 8, 2);
    Positions x = testing::perturbed(random, mesh, 0.05);
    FastProjection::Settings settings{0.01};
    settings.sweeps_before = 100'000;  // they end when nothing is left to correct
    WorkCounters work;
    const StepResult result = FastProjection(*mesh.problem, settings).apply(mesh.x, h, x, work);
    ASSERT_TRUE(result);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_EQ(work.factorizations, 0);
    EXPECT_GT(work.edge_projections, 0);
    EXPECT_TRUE(EdgeConstraints(*mesh.problem, settings.strain_limit).permissible(x));
  }
}

TEST(FastProjection, SweepsNeverOnChains) {
  Random random(4);
  const auto chain = random_mesh(random, 1, 20, 1);
  const Positions candidate = testing::perturbed(random, chain, 0.05);
  FastProjection::Settings settings{0.001};
  WorkCounters plain, swept;
  Positions x = candidate, y = candidate;
  ASSERT_TRUE(FastProjection(*chain.problem, settings).apply(chain.x, h, x, plain));
  settings.sweeps_before = settings.smoothing_sweeps = 30;
  ASSERT_TRUE(FastProjection(*chain.problem, settings).apply(chain.x, h, y, swept));
  EXPECT_TRUE(same_bits(x, y));
  EXPECT_EQ(plain, swept);
}

TEST(Jacobi, ConvergesAtValenceThirtyWithUnequalMasses) {
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass.push_back(1e-3);
  Positions x = Positions::Zero(3, 31);
  for (int i = 1; i <= 30; ++i) {
    parts.mass.push_back(i % 2 ? 1.0 : 1e-3);
    parts.edges.push_back({0, i});
    parts.rest_length.push_back(1);
    x.col(i) << std::cos(0.2 * i), std::sin(0.2 * i), 0.01 * i;
  }
  x *= 1.3;  // every edge 30 % too long
  const auto problem = std::make_shared<const Problem>(std::move(parts));
  const auto stepper = make_stepper("jacobi", problem, {1e-3, 1, {}});
  State state{x, Positions::Zero(3, 31), 0};
  EXPECT_TRUE(stepper->advance(state, h));
}

// The unsteady part of C11: matrices of fast projection and ICD on the same mesh.
// Hairs of unequal length in one problem, each pinned somewhere, some springs twice.
RandomMesh random_hairs(Random& random, int hairs) {
  RandomMesh mesh;
  ProblemParts parts;
  for (int hair = 0; hair < hairs; ++hair) {
    const int first = static_cast<int>(parts.mass.size());
    const int length = 2 + static_cast<int>(random() % 9);
    parts.pinned.push_back(first + static_cast<int>(random() % 3) * (length - 1) / 2);
    for (int v = first; v < first + length; ++v) {
      parts.mass.push_back(testing::uniform(random, 0.1, 1));
      if (v == first) continue;
      parts.edges.push_back(random() % 2 ? Edge{v - 1, v} : Edge{v, v - 1});
      if (random() % 4 == 0) parts.edges.push_back({v - 1, v});
    }
  }
  mesh.x = Positions::NullaryExpr(3, static_cast<Eigen::Index>(parts.mass.size()),
                                  [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
  for (const Edge e : parts.edges)
    parts.rest_length.push_back((mesh.x.col(e.b) - mesh.x.col(e.a)).norm());
  mesh.problem = std::make_shared<const Problem>(std::move(parts));
  return mesh;
}

// The solver for chains against one that takes any matrix, in another elimination order.
TEST(ImplicitSprings, TakeTheSameStepsByEitherFactorizationOfChains) {
  for (std::uint64_t seed = 0; seed < 3 * seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RandomMesh mesh = random_hairs(random, 1 + static_cast<int>(seed % 4));
    const State start = moving_state(random, mesh, 1);
    const auto run = [&](const char* linear_solver) {
      const auto stepper = make_stepper(
          "implicit_springs", mesh.problem,
          {1e-2, 1, {{"linear_solver", std::string(linear_solver)}, {"newton_tolerance", 1e-6}}});
      State state = start;
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(stepper->advance(state, h));
      EXPECT_STREQ(stepper->linear_solver(),
                   std::string_view(linear_solver) == "auto" ? "block_tridiagonal" : linear_solver);
      return state.x;
    };
    const Positions chain = run("auto"), general = run("cholmod_simplicial");
    EXPECT_LT((chain - general).norm(), 1e-8 * general.norm());
  }
}

TEST(ImplicitSprings, SayWhereChainsAreNeeded) {
  Random random(1);
  const RandomMesh cloth = random_mesh(random, 3, 3, 1);
  EXPECT_STREQ(make_stepper("implicit_springs", cloth.problem, {})->linear_solver(),
               "multifrontal");
  EXPECT_THROW(make_stepper("implicit_springs", cloth.problem,
                            {0.01, 1, {{"linear_solver", std::string("block_tridiagonal")}}}),
               std::invalid_argument);
}

TEST(Stepper, ReadsNoClockUnlessPhasesAreWanted) {
  for (const Backend& backend : backends()) {
    if (backend.strain_control != StrainControl::strain_limit) continue;
    SCOPED_TRACE(backend.name);
    Random random(2);
    const RandomMesh mesh = random_mesh(random, 1, 9, 1);
    const auto stepper = make_stepper(backend.name, mesh.problem, {0.1, 1, {}});
    State state = moving_state(random, mesh, 0.1);
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_EQ(stepper->phases().unconstrained, 0);
    EXPECT_EQ(stepper->phases().filter, 0);
    stepper->measure_phases(true);
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_GT(stepper->phases().unconstrained, 0);
    EXPECT_GT(stepper->phases().filter, 0);
  }
}

TEST(Counters, FastProjectionFactorsAMuchSmallerMatrixThanIcd) {
  Random random(5);
  const auto mesh = random_mesh(random, 15, 15, 0);
  WorkCounters fast, icd;
  Positions x = testing::perturbed(random, mesh, 0.02), y = x;
  ASSERT_TRUE(FastProjection(*mesh.problem, {1e-6}).apply(mesh.x, h, x, fast));
  Icd::Settings factored{1e-6};
  factored.linear_solver = "quasi_definite";
  ASSERT_TRUE(Icd(*mesh.problem, factored).apply(mesh.x, h, y, icd));
  EXPECT_LT(2 * fast.factor_nonzeros, icd.factor_nonzeros);
  EXPECT_LT(2 * fast.factor_flops, icd.factor_flops);
}

}  // namespace
}  // namespace inextensible
