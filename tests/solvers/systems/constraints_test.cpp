// C, its gradient, J W J^T with and without contacts, SHAKE's matrix and constrained accelerations,
// by slow second routes and mechanics. (Starting half a step back is what lets every method fall
// exactly: every_method_test.cpp.)
#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include "solvers/linear/spd_solver.h"
#include "solvers/systems/constrained_acceleration.h"
#include "solvers/systems/schur_complement.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, testing::Random, testing::random_mesh;
using Triangle = SymmetricPattern::Triangle;
constexpr std::uint64_t seeds = 20;

// C is quadratic: central differences are exact.
TEST(EdgeConstraints, GradientMatchesCentralDifferencesOfC) {
  testing::for_seeds(seeds, [&](testing::Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 3, 4, 1);
    const Positions x = testing::perturbed(random, mesh, 0.3);
    const EdgeConstraints edges(*mesh.problem, 0.01);
    const int m = edges.count();
    Eigen::Matrix3Xd u(3, m), ignored(3, m);
    VectorXd c(m), plus(m), minus(m), rate(m);
    edges.linearize(x, u, c);
    for (int trial = 0; trial < 36; ++trial) {
      const Positions way = testing::random_matrix(random, 3, x.cols());
      edges.linearize(x + way, ignored, plus);
      edges.linearize(x - way, ignored, minus);
      edges.rate(u, way, rate);
      EXPECT_LT(((plus - minus) / 2 - rate).cwiseAbs().maxCoeff(), 1e-12);
    }
  });
}

TEST(EdgeConstraints, NaNIsNeverPermissible) {
  Random random(1);
  const auto mesh = random_mesh(random, 3, 3, 0);
  const EdgeConstraints edges(*mesh.problem, 0.01);
  Eigen::Matrix3Xd u(3, edges.count());
  VectorXd c(edges.count());
  EXPECT_TRUE(edges.permissible(mesh.x));
  for (int v = 0; v < 9; ++v) {
    Positions x = mesh.x;
    x(1, v) = std::nan("");
    EXPECT_FALSE(edges.permissible(x));
    EXPECT_FALSE(edges.linearize(x, u, c));
    EXPECT_TRUE(std::isinf(edges.worst(x).strain));
  }
}

TEST(EdgeConstraints, WorstNamesTheProblemsEdgeInAnyOrder) {
  testing::for_seeds(seeds, [&](testing::Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 4, 4, 2);
    const Problem& p = *mesh.problem;
    const Positions x = testing::perturbed(random, mesh, 0.2);
    int expected = 0;
    std::vector<double> strain;
    for (std::size_t k = 0; k < p.edges().size(); ++k) {
      const auto [a, b] = p.edges()[k];
      strain.push_back((x.col(b) - x.col(a)).norm() / p.rest_length()[k] - 1);
      if (std::abs(strain[k]) > std::abs(strain[expected])) expected = static_cast<int>(k);
    }
    const double most = strain[expected];
    std::vector<int> order(strain.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    // The limit is inclusive; on either side of it both checks agree.
    for (const double factor : {1 - 1e-9, 1 + 1e-9}) {
      const EdgeConstraints edges(p, std::abs(most) * factor, order);
      EXPECT_EQ(edges.worst(x).edge, expected);
      EXPECT_NEAR(edges.worst(x).strain, most, 1e-14);
      Eigen::Matrix3Xd u(3, edges.count());
      VectorXd c(edges.count());
      EXPECT_EQ(edges.permissible(x), factor > 1);
      EXPECT_EQ(edges.linearize(x, u, c), factor > 1);
    }
  });
}

// With two edges between the same vertices, in opposite directions: their entries meet in one
// place. Some vertices are held by planes, and move within these: W (I - n n^T).
TEST(SchurComplement, EqualsTheDenseProductInEachTriangleWithAndWithoutContacts) {
  testing::for_seeds(seeds, [&](testing::Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 4, 5, 3);
    ProblemParts parts = testing::parts_of(*mesh.problem);
    parts.edges.push_back({parts.edges[2].b, parts.edges[2].a});
    parts.rest_length.push_back(0.7);
    parts.collider = std::make_shared<const testing::Ground>(Eigen::Vector3d(0.3, 1, 0.2), 1, 0.4);
    const Problem problem(parts);
    const Positions y = testing::perturbed(random, mesh, 0.3);
    Positions x = testing::perturbed(random, mesh, 0.3);
    Contacts contacts(problem);
    WorkCounters work;
    contacts.begin(mesh.x, 0, 0.01);
    contacts.find(x, work);
    contacts.settle(x);
    for (int v = 0; v < problem.vertices(); v += 2) x(1, v) += 0.5;  // some are let go of
    contacts.settle(x);

    const MatrixXd jx = testing::dense_gradient(problem, x),
                   jy = testing::dense_gradient(problem, y);
    const EdgeConstraints edges(problem, 0.01);
    Eigen::Matrix3Xd ux(3, edges.count()), uy(3, edges.count());
    edges.gradient(x, ux);
    edges.gradient(y, uy);
    std::vector<double> other_w = problem.inverse_mass();
    for (double& one : other_w) one *= testing::uniform(random, 0.5, 2);
    for (const auto triangle : {Triangle::lower, Triangle::upper, Triangle::both})
      for (const bool weighed : {false, true})
        for (const bool touching : {false, true}) {
          SCOPED_TRACE(touching ? "contacts" : "no contacts");
          SchurComplement schur(edges, problem.vertices(), triangle);
          if (weighed) schur.weigh(other_w.data());
          const std::vector<double>& w = weighed ? other_w : problem.inverse_mass();
          MatrixXd mobility = MatrixXd::Zero(jx.cols(), jx.cols());
          for (Eigen::Index i = 0; i < jx.cols(); ++i) mobility(i, i) = w[i / 3];
          int held = 0;
          for (int c = 0; touching && c < contacts.count(); ++c) {
            if (!contacts.holds(c)) continue;
            const Eigen::Vector3d n = contacts.normal(c);
            const int i = 3 * contacts.vertex(c);
            mobility.block<3, 3>(i, i) *= Eigen::Matrix3d::Identity() - n * n.transpose();
            ++held;
          }
          EXPECT_EQ(held > 0, touching);
          const bool both = triangle == Triangle::both;
          const Eigen::Matrix3Xd& right = both ? uy : ux;
          const SymmetricPattern& pattern = schur.pattern();
          std::vector<double> values(pattern.entries());
          schur.assemble(ux, right, values.data());
          if (touching) schur.subtract_contacts(contacts, ux, right, values.data());
          MatrixXd found = Eigen::Map<const Eigen::SparseMatrix<double>>(
              pattern.n, pattern.n, pattern.entries(), pattern.column_start.data(),
              pattern.row_index.data(), values.data());
          if (!both)
            found = triangle == Triangle::lower ? MatrixXd(found.selfadjointView<Eigen::Lower>())
                                                : MatrixXd(found.selfadjointView<Eigen::Upper>());
          EXPECT_LT((found - jx * mobility * (both ? jy : jx).transpose()).norm(), 1e-11);
        }
  });
}

// SHAKE's matrix, directions at two positions; a tree that is a path has a tridiagonal one.
TEST(LuSolver, IsBackwardStableOnShakesMatrices) {
  for (const bool chain : {true, false})
    testing::for_seeds(seeds, [&](testing::Random& random, std::uint64_t seed) {
      SCOPED_TRACE((chain ? "chain, seed " : "graph, seed ") + std::to_string(seed));
      const auto graph =
          chain ? random_mesh(random, 1, 40, 1) : testing::random_graph(random, 40, 25, 3, 1e-2);
      const Problem& problem = *graph.problem;
      const EdgeConstraints edges(problem, 0.01);
      const Positions y = testing::perturbed(random, graph, 0.1);
      Eigen::Matrix3Xd ux(3, edges.count()), uy(3, edges.count());
      edges.gradient(graph.x, ux);
      edges.gradient(y, uy);
      const SchurComplement schur(edges, problem.vertices(), Triangle::both);
      const auto solver = make_lu_solver(schur.pattern());
      schur.assemble(uy, ux, solver->values());
      const MatrixXd matrix =
          testing::dense_gradient(problem, y) * testing::dense_moves(problem, graph.x);
      ASSERT_TRUE(solver->factor());
      const VectorXd b = VectorXd::LinSpaced(edges.count(), -1, 2);
      VectorXd x = b;
      solver->solve(x.data());
      EXPECT_LT((matrix * x - b).norm(), 1e-12 * (matrix.norm() * x.norm() + b.norm()));
    });
}

// [1 1 0; 1 2 1; 0 1 1], whose middle row is the sum of the others, and all ones.
TEST(LuSolver, SeesDependentRowsWithoutAnyZeroColumn) {
  for (const bool tridiagonal : {true, false}) {
    const Pairs chain{{0, 1}, {1, 2}}, full{{0, 1}, {0, 2}, {1, 2}};
    const SymmetricPattern pattern = pattern_of(3, tridiagonal ? chain : full, Triangle::both);
    const auto solver = make_lu_solver(pattern);
    std::fill_n(solver->values(), pattern.entries(), 1);
    if (tridiagonal) solver->values()[pattern.place(1, 1)] = 2;
    EXPECT_FALSE(solver->factor()) << tridiagonal;
    solver->values()[0] = std::nan("");
    EXPECT_FALSE(solver->factor()) << tridiagonal;
  }
}

// a = W f - W J^T lambda from the definitions.
TEST(ConstrainedAcceleration, IsThatOfDenseAlgebra) {
  testing::for_seeds(20, [&](testing::Random& random, std::uint64_t seed) {
    const auto mesh = seed % 2 ? testing::random_mesh(random, 5, 6, 3)
                               : testing::random_graph(random, 30, 20, 2, 1e-3);
    ProblemParts parts = testing::parts_of(*mesh.problem);
    parts.gravity = {1, -9.81, 2};
    const Problem p(parts);
    const State state = testing::moving_state(random, mesh, 1);
    const MatrixXd j = testing::dense_gradient(p, state.x), wjt = testing::dense_moves(p, state.x);
    Positions fall = p.gravity().replicate(1, p.vertices());
    for (const int v : p.pinned()) fall.col(v).setZero();
    // J' v: J is linear in x.
    const VectorXd curvature = testing::dense_gradient(p, state.v) * state.v.reshaped();
    const VectorXd rhs = j * fall.reshaped() + curvature;
    const VectorXd expected = fall.reshaped() - wjt * (j * wjt).ldlt().solve(rhs);
    const Positions a = constrained_acceleration(p, state);
    EXPECT_LT((a.reshaped() - expected).norm(), 1e-8 * expected.norm());
    for (const int v : p.pinned()) EXPECT_EQ(a.col(v), Eigen::Vector3d::Zero());
  });
}

// A straight row of unequal masses between two pins: J W J^T is singular.
TEST(ConstrainedAcceleration, OfATautRowIsWhatTheRowCannotHinder) {
  Positions x = Positions::Zero(3, 5);
  x.row(0) << 0, 1, 2, 3, 4;
  ProblemParts parts =
      testing::parts_at_rest(x, {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {1, 2, 0.5, 3, 1}, {0, 4});
  parts.gravity = {4, -9, 0};
  const Positions a = constrained_acceleration(Problem(parts), {x, Positions::Zero(3, 5), 0});
  for (int v = 1; v < 4; ++v) EXPECT_NEAR((a.col(v) - Eigen::Vector3d(0, -9, 0)).norm(), 0, 1e-6);
}

// An edge of no length has no direction, and no force.
TEST(ConstrainedAcceleration, KnowsNoForceOfAnEdgeWithoutLength) {
  const testing::HangingRope rope(2, 1, 1);
  State start = rope.start;
  start.x.col(2) = start.x.col(1);
  const Positions a = constrained_acceleration(*rope.problem, start);
  EXPECT_NEAR(a.col(1).norm(), 0, 1e-12);
  EXPECT_NEAR((a.col(2) - rope.problem->gravity()).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace inextensible
