// Scenes as they are meant to be, against the pendulum's exact solution, and counters against those
// of an independent program.
#include "harness/scenes/scene.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_elljac.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/forces.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"
#include "solvers/systems/schur_complement.h"
#include "support/contact.h"
#include "support/effort.h"
#include "support/scenes.h"

namespace harness {
namespace {

using inextensible::State;
using testing::build;

TEST(Chain, HasNoPartsThatItDoesNotAskFor) {
  const Scene chain = build("chain", {});
  EXPECT_EQ(chain.problem->shear(), nullptr);
  EXPECT_EQ(chain.problem->collider(), nullptr);
  State state = chain.start;
  const auto stepper = inextensible::make_stepper("fast_projection", chain.problem, {});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(stepper->advance(state, 0.01));
  EXPECT_EQ(stepper->work().spring_evaluations, 0);
  EXPECT_EQ(stepper->work().triangle_tests, 0);
  EXPECT_STREQ(stepper->linear_solver(), "tridiagonal");
  // Six to seven iterations a step at 80 vertices, 1 %, 0.01 s (an independent program's figure).
  EXPECT_GE(stepper->work().iterations, 600);
  EXPECT_LE(stepper->work().iterations, 700);
}

TEST(Drape, HasThePapersSizes) {
  const Scene drape = build("drape", {});
  EXPECT_EQ(drape.problem->vertices(), 5041);
  EXPECT_EQ(drape.problem->constraints(), 9940);
  EXPECT_EQ(drape.problem->shear()->edges.size(), 9800u);
  EXPECT_EQ(drape.problem->collider()->triangles(), 1280);
  const inextensible::EdgeConstraints edges(*drape.problem, 0.01);
  const inextensible::SchurComplement schur(edges, 5041,
                                            inextensible::SymmetricPattern::Triangle::upper);
  EXPECT_EQ(schur.pattern().entries(), 39338);
}

// What fast projection does for singular matrices costs nothing where they are regular: one
// assembly, one factorization and one solve an iteration, nothing taken back.
TEST(FastProjection, DampsNothingWhereTheMatrixIsRegular) {
  const Scene chain = build("chain", {{"n", 80}}), net = build("spinning_net", {{"n", 15}});
  for (const Scene* scene : {&chain, &net}) {
    State state = scene->start;
    const auto stepper =
        inextensible::make_stepper("fast_projection", scene->problem, {0.001, 1, {}});
    for (int i = 0; i < 400; ++i) ASSERT_TRUE(stepper->advance(state, 1.0 / 400));
    const auto& work = stepper->work();
    EXPECT_GT(work.iterations, 0);
    EXPECT_EQ(work.line_search_steps, 0);
    EXPECT_EQ(work.assemblies, work.iterations);
    EXPECT_EQ(work.factorizations, work.iterations);
    EXPECT_EQ(work.back_solves, work.iterations);
  }
}

// Figure 1 of the paper: the row between the pins is straight at full length, J W J^T singular.
TEST(Patch, IsSurvivedByFastProjectionAtAllLimits) {
  const Scene patch = build("patch", {{"n", 15}});
  for (const double limit : {0.1, 0.01, 0.001}) {
    State state = patch.start;
    const auto stepper =
        inextensible::make_stepper("fast_projection", patch.problem, {limit, 1, {}});
    for (int i = 0; i < 400; ++i) {
      const auto step = stepper->advance(state, 1.0 / 400);
      ASSERT_TRUE(step) << "limit " << limit << ", step " << i << ": " << step.detail;
    }
  }
}

// Rows lie below their pins, as the cloth was cut; marks are the middles of the first and the last
// row.
TEST(HungPatch, IsThePatchTurnedAboutItsPins) {
  for (const double tilt : {0.0, 0.3}) {
    const Scene hung = build("hung_patch", {{"n", 9}, {"tilt", tilt}, {"side", 2}});
    const inextensible::Problem& problem = *hung.problem;
    for (std::size_t k = 0; k < problem.edges().size(); ++k) {
      const auto [a, b] = problem.edges()[k];
      EXPECT_NEAR((hung.start.x.col(b) - hung.start.x.col(a)).norm(), problem.rest_length()[k],
                  1e-15);
    }
    ASSERT_EQ(hung.marks.size(), 2u);
    EXPECT_EQ(hung.start.x.col(hung.marks[0].vertex), Eigen::Vector3d::Zero());
    EXPECT_NEAR(hung.start.x(1, hung.marks[1].vertex), -2 * std::cos(tilt), 1e-15);
    EXPECT_EQ(hung.marks[1].height, -2);
  }
}

// Springs come to rest; a row that is longer by a strain sags at most as two straight halves would.
TEST(HungPatch, OfSpringsComesToRestAndSagsNoMoreThanItsTopRowIsLonger) {
  const Scene hung = build("hung_patch", {{"n", 9}});
  double last_sag = 0;
  for (const double stiffness : {1000.0, 10.0, 1.0}) {
    State state = hung.start;
    const auto stepper = inextensible::make_stepper("implicit_springs", hung.problem,
                                                    {0.01, 1, {{"stiffness", stiffness}}});
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(stepper->advance(state, 1.0 / 50));
    double length = 0;
    for (int j = 0; j + 1 < 9; ++j) length += (state.x.col(j + 1) - state.x.col(j)).norm();
    const double sag = -state.x(1, hung.marks[0].vertex);
    EXPECT_GT(sag, last_sag);
    EXPECT_LE(sag, std::sqrt(length * length - 1) / 2);
    EXPECT_LT(state.v.cwiseAbs().maxCoeff(), 0.01);
    last_sag = sag;
  }
}

TEST(Drape, KeepsItsMirrorSymmetryUnderADirectFilterUntilContact) {
  const Scene drape = build("drape", {{"n", 15}, {"gap", 0.2}});
  State state = drape.start;
  state.v.row(1) = (5 * state.x.row(0).array().square()).matrix();  // bends it, symmetrically
  const auto stepper = inextensible::make_stepper("fast_projection", drape.problem, {0.001, 1, {}});
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(stepper->advance(state, 0.005));
  EXPECT_EQ(stepper->work().contacts, 0);
  EXPECT_GT(stepper->work().factorizations, 0);
  for (const auto& mirror : drape.mirrors) {
    for (Eigen::Index v = 0; v < state.x.cols(); ++v) {
      const Eigen::Vector3d reflected =
          state.x.col(v) - 2 * mirror.normal.dot(state.x.col(v)) * mirror.normal;
      EXPECT_LT((reflected - state.x.col(mirror.image[v])).norm(), 1e-9);
    }
  }
}

// A chain of one link, released from the horizontal, is the mathematical pendulum: with theta from
// the vertical, sin(theta / 2) = k sn(K - omega t, k), k = sin(pi / 4), omega = sqrt(g / l).
Eigen::Vector2d pendulum(double length, double t) {
  const double k = std::sin(M_PI / 4), omega = std::sqrt(9.81 / length);
  double sn = 0, cn = 0, dn = 0;
  gsl_sf_elljac_e(gsl_sf_ellint_Kcomp(k, GSL_PREC_DOUBLE) - omega * t, k * k, &sn, &cn, &dn);
  const double theta = 2 * std::asin(k * sn);
  return {length * std::sin(theta), -length * std::cos(theta)};
}

// The slope of log error over log step at t = 0.4 s.
double order(const std::string& solver, double limit, const inextensible::Settings& settings) {
  const Scene scene = build("chain", {{"n", 2}});
  std::vector<double> log_h, log_error;
  for (int steps = 50; steps <= 800; steps *= 2) {
    const double h = 0.4 / steps;
    State state = scene.start;
    const auto stepper = inextensible::make_stepper(solver, scene.problem, {limit, 1, settings});
    for (int i = 0; i < steps; ++i) {
      if (!stepper->advance(state, h)) return std::nan("");
    }
    log_h.push_back(std::log(h));
    log_error.push_back(std::log((state.x.col(1).head<2>() - pendulum(1, 0.4)).norm()));
  }
  double intercept = 0, slope = 0, c00 = 0, c01 = 0, c11 = 0, chi = 0;
  gsl_fit_linear(log_h.data(), 1, log_error.data(), 1, log_h.size(), &intercept, &slope, &c00, &c01,
                 &c11, &chi);
  return slope;
}

TEST(Pendulum, ExactSolutionStartsHorizontalAndConservesEnergy) {
  EXPECT_LT((pendulum(1, 0) - Eigen::Vector2d(1, 0)).norm(), 1e-12);
  const double dt = 1e-5, t = 0.3;
  const double speed2 = ((pendulum(1, t + dt) - pendulum(1, t - dt)) / (2 * dt)).squaredNorm();
  EXPECT_NEAR(speed2, -2 * 9.81 * pendulum(1, t)[1], 1e-6);
}

TEST(Pendulum, EveryMethodConvergesToTheExactSolutionAtFirstOrder) {
  for (const char* solver : {"jacobi", "gauss_seidel", "shake", "icd", "fast_projection"}) {
    const double slope = order(solver, 1e-9, {});
    RecordProperty(solver, std::to_string(slope));
    EXPECT_GT(slope, 0.85) << solver;
    EXPECT_LT(slope, 1.3) << solver;
  }
  const double springs = order("implicit_springs", 1e-6, {{"stiffness", 1e8}});
  EXPECT_GT(springs, 0.85);
  EXPECT_LT(springs, 1.3);
}

TEST(Energy, OfTheChainDoesNotRise) {
  for (const char* solver : {"implicit_springs", "icd", "fast_projection"}) {
    const Scene chain = build("chain", {{"n", 20}});
    State state = chain.start;
    const auto stepper = inextensible::make_stepper(solver, chain.problem, {1e-6, 1, {}});
    const auto energy = [&] {
      return inextensible::potential_energy(*chain.problem, state.x) +
             inextensible::kinetic_energy(*chain.problem, state.v);
    };
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(stepper->advance(state, 0.005)) << solver;
      EXPECT_LT(energy(), 1e-6) << solver << " step " << i;
    }
  }
}

// ---- Collider ----

TEST(Icosphere, IsClosedAndMirrorSymmetric) {
  for (int level = 0; level <= 3; ++level) {
    const auto mesh = inextensible::icosphere(Eigen::Vector3d::Zero(), 0.25, level);
    EXPECT_EQ(mesh.triangles.size(), 20u << (2 * level));
    EXPECT_NO_THROW(inextensible::TriangleCollider(mesh, 0.3));  // refuses open meshes
    for (const Eigen::Vector3d& v : mesh.vertices) {
      EXPECT_NEAR(v.norm(), 0.25, 1e-15);
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3d image = v;
        image[axis] = -image[axis];
        EXPECT_TRUE(
            std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                        [&](const Eigen::Vector3d& w) { return (w - image).norm() < 1e-14; }));
      }
    }
  }
  auto open = inextensible::icosphere(Eigen::Vector3d::Zero(), 1, 1);
  open.triangles.pop_back();
  EXPECT_THROW(inextensible::TriangleCollider(open, 0), std::invalid_argument);
}

TEST(TriangleCollider, GridFindsWhatASearchOfAllTrianglesFinds) {
  const inextensible::TriangleCollider collider(
      inextensible::icosphere(Eigen::Vector3d::Zero(), 0.25, 3), 0.3);
  std::uint64_t state = 1;
  const auto random = [&state] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
  };
  for (int i = 0; i < inextensible::testing::trials(20000); ++i) {
    const Eigen::Vector3d p(0.54 * random(), 0.54 * random(), 0.54 * random());
    const auto quick = collider.nearest(p), slow = collider.nearest_by_all(p);
    ASSERT_NEAR(quick.signed_distance, slow.signed_distance, 1e-14) << p.transpose();
    if (p.norm() > 0.25) {
      EXPECT_GT(slow.signed_distance, 0);
    }
    if (p.norm() < 0.24) {
      EXPECT_LT(slow.signed_distance, 0);
    }
  }
}

// A vertex pressed 1 cm into the top of a sphere of 1,280 faces, with a sideways displacement.
Eigen::Vector3d press(double sideways, double friction) {
  const auto collider = std::make_shared<const inextensible::TriangleCollider>(
      inextensible::icosphere(Eigen::Vector3d::Zero(), 0.25, 0), friction);
  // The centre of a face; tangent, normal and the point in its frame.
  const auto mesh = inextensible::icosphere(Eigen::Vector3d::Zero(), 0.25, 0);
  const auto& t = mesh.triangles[0];
  const Eigen::Vector3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  const Eigen::Vector3d centre = (a + b + c) / 3, tangent = (b - a).normalized(),
                        normal = centre.normalized();
  Eigen::Matrix3Xd start(3, 1), x(3, 1);
  start.col(0) = centre;
  x.col(0) = centre + sideways * tangent - 0.01 * normal;
  inextensible::WorkCounters work;
  inextensible::testing::push_out(collider, start, x, work);
  EXPECT_EQ(work.contacts, 1);
  const Eigen::Vector3d moved = x.col(0) - centre;
  return {moved.dot(tangent), moved.dot(normal),
          (moved - moved.dot(tangent) * tangent - moved.dot(normal) * normal).norm()};
}

TEST(TriangleCollider, FrictionSticksBelowAndSlidesAboveCoulombsLimit) {
  EXPECT_LT((press(0.002, 0.3) - Eigen::Vector3d(0, 0, 0)).norm(), 1e-12);  // 2 mm < 0.3 x 1 cm
  EXPECT_LT((press(0.005, 0.3) - Eigen::Vector3d(0.002, 0, 0)).norm(),
            1e-12);  // slides on by the rest
  EXPECT_LT((press(0.005, 0) - Eigen::Vector3d(0.005, 0, 0)).norm(), 1e-12);
}

TEST(TriangleCollider, LeavesPinnedVerticesWhereTheyAre) {
  const auto collider = std::make_shared<const inextensible::TriangleCollider>(
      inextensible::icosphere(Eigen::Vector3d::Zero(), 0.25, 2), 0.3);
  Eigen::Matrix3Xd x = Eigen::Matrix3Xd::Constant(3, 1, 0.01);
  const Eigen::Matrix3Xd start = x;
  inextensible::WorkCounters work;
  inextensible::testing::push_out(collider, start, x, work, {0});
  EXPECT_EQ(x, start);
}

}  // namespace
}  // namespace harness
