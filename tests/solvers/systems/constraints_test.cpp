// C, its gradient, J W J^T and the linear solvers, each against a slow second route.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "solvers/linear/lu.h"
#include "solvers/linear/quasi_definite.h"
#include "solvers/linear/spd_solvers.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/systems/schur_complement.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using testing::Random;
using testing::random_mesh;
constexpr int seeds = 20;

Eigen::MatrixXd dense(const SymmetricPattern& pattern, const double* values) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
  for (int j = 0; j < pattern.n; ++j) {
    for (int i = pattern.column_start[j]; i < pattern.column_start[j + 1]; ++i) {
      const int row = pattern.row_index[i];
      matrix(row, j) = matrix(j, row) = values[i];
    }
  }
  return matrix;
}

TEST(EdgeConstraints, GradientMatchesCentralDifferencesOfC) {
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const auto mesh = random_mesh(random, 3, 4, 1);
    const Positions x = testing::perturbed(random, mesh, 0.3);
    const EdgeConstraints edges(*mesh.problem, 0.01);
    const int m = edges.count();
    Eigen::Matrix3Xd u(3, m), ignored(3, m);
    Eigen::VectorXd c(m), plus(m), minus(m);
    edges.linearize(x, u, c);
    const double step = 1e-5;
    for (Eigen::Index i = 0; i < 3 * x.cols(); ++i) {
      Positions shifted = x;
      shifted.data()[i] += step;
      edges.linearize(shifted, ignored, plus);
      shifted.data()[i] -= 2 * step;
      edges.linearize(shifted, ignored, minus);
      for (int k = 0; k < m; ++k) {
        const int vertex = static_cast<int>(i / 3), axis = static_cast<int>(i % 3);
        const double expected = vertex == edges.b[k]   ? u(axis, k)
                                : vertex == edges.a[k] ? -u(axis, k)
                                                       : 0;
        EXPECT_NEAR((plus[k] - minus[k]) / (2 * step), expected, 1e-8);
      }
    }
  }
}

TEST(EdgeConstraints, NaNIsNeverPermissible) {
  Random random(1);
  const auto mesh = random_mesh(random, 3, 3, 0);
  const EdgeConstraints edges(*mesh.problem, 0.01);
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count());
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
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
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
      Eigen::VectorXd c(edges.count());
      EXPECT_EQ(edges.permissible(x), factor > 1);
      EXPECT_EQ(edges.linearize(x, u, c), factor > 1);
    }
  }
}

TEST(SchurComplement, EqualsTheDenseProductInBothTriangles) {
  for (int seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    auto mesh = random_mesh(random, 4, 5, 3);
    // Two edges between the same vertices, in opposite directions: their entries meet in one place.
    ProblemParts parts;
    parts.mass = mesh.problem->mass();
    parts.pinned = mesh.problem->pinned();
    parts.edges = mesh.problem->edges();
    parts.rest_length = mesh.problem->rest_length();
    parts.edges.push_back({parts.edges[2].b, parts.edges[2].a});
    parts.rest_length.push_back(0.7);
    const Problem problem(parts);
    const Positions x = testing::perturbed(random, mesh, 0.3),
                    y = testing::perturbed(random, mesh, 0.3);
    const Eigen::MatrixXd jx = testing::dense_gradient(problem, x),
                          jy = testing::dense_gradient(problem, y);
    const Eigen::VectorXd inverse_mass = testing::inverse_masses3(problem);
    const auto w = inverse_mass.asDiagonal();
    const EdgeConstraints edges(problem, 0.01);
    Eigen::Matrix3Xd ux(3, edges.count()), uy(3, edges.count());
    edges.gradient(x, ux);
    edges.gradient(y, uy);
    for (const auto triangle :
         {SymmetricPattern::Triangle::lower, SymmetricPattern::Triangle::upper}) {
      const SchurComplement schur(edges, problem.vertices(), triangle);
      std::vector<double> values(schur.pattern().entries());
      schur.assemble(ux, values.data());
      EXPECT_LT((dense(schur.pattern(), values.data()) - jx * w * jx.transpose()).norm(), 1e-11);
    }
    const UnsymmetricSchurComplement both(edges, problem.vertices());
    std::vector<double> values(both.row_index.size());
    both.assemble(ux, uy, values.data());
    const Eigen::Map<const Eigen::SparseMatrix<double>> sparse(
        edges.count(), edges.count(), static_cast<int>(values.size()), both.column_start.data(),
        both.row_index.data(), values.data());
    EXPECT_LT((Eigen::MatrixXd(sparse) - jx * w * jy.transpose()).norm(), 1e-11);
  }
}

TEST(FillReducingOrder, IsAPermutation) {
  Random random(3);
  const auto mesh = random_mesh(random, 9, 7, 2);
  const EdgeConstraints edges(*mesh.problem, 0.01);
  const SchurComplement schur(edges, mesh.problem->vertices(), SymmetricPattern::Triangle::upper);
  std::vector<int> order = fill_reducing_order(schur.pattern());
  std::sort(order.begin(), order.end());
  for (int i = 0; i < edges.count(); ++i) EXPECT_EQ(order[i], i);
}

// The J W J^T of a mesh (a chain for the tridiagonal solver) with its dense form.
struct Matrix {
  std::unique_ptr<SpdSolver> solver;
  Eigen::MatrixXd dense;
};

Matrix matrix_for(const std::string& name, std::uint64_t seed) {
  Random random(seed);
  const auto mesh =
      name == "tridiagonal" ? random_mesh(random, 1, 30, 1) : random_mesh(random, 8, 9, 2);
  const EdgeConstraints edges(*mesh.problem, 0.01);
  const SchurComplement schur(edges, mesh.problem->vertices(), triangle_of(name));
  Eigen::Matrix3Xd u(3, edges.count());
  edges.gradient(testing::perturbed(random, mesh, 0.1), u);
  Matrix matrix;
  matrix.solver = make_spd_solver(name, schur.pattern());
  schur.assemble(u, matrix.solver->values());
  matrix.dense = dense(schur.pattern(), matrix.solver->values());
  return matrix;
}

class SpdSolvers : public ::testing::TestWithParam<const char*> {};

TEST_P(SpdSolvers, LeaveASmallResidualAndRepeatFactorizations) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Matrix matrix = matrix_for(GetParam(), seed);
    for (int round = 0; round < 3; ++round) {  // the same pattern, other values
      ASSERT_TRUE(matrix.solver->factor());
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(matrix.dense.rows(), -1, 2);
      Eigen::VectorXd x = b;
      matrix.solver->solve(x.data());
      EXPECT_LT((matrix.dense * x - b).norm(), 1e-9 * b.norm());
      EXPECT_GE(matrix.solver->factor_nonzeros(), static_cast<double>(matrix.dense.rows()));
      matrix.solver->values()[0] *= 1.5;
      matrix.dense(0, 0) *= 1.5;
    }
  }
}

TEST_P(SpdSolvers, RefuseWhatIsNotPositiveDefinite) {
  Matrix matrix = matrix_for(GetParam(), 5);
  const double kept = matrix.solver->values()[0];
  matrix.solver->values()[0] = -1;  // a diagonal entry, the first in either triangle
  EXPECT_FALSE(matrix.solver->factor());
  matrix.solver->values()[0] = std::nan("");
  EXPECT_FALSE(matrix.solver->factor());
  matrix.solver->values()[0] = kept;
  EXPECT_TRUE(matrix.solver->factor()) << "a failed factorization must not corrupt the next";
}

INSTANTIATE_TEST_SUITE_P(All, SpdSolvers,
                         ::testing::Values("tridiagonal", "cholmod_simplicial",
                                           "cholmod_supernodal", "multifrontal"));

TEST(UnsymmetricSolver, LeavesASmallResidualAndSeesSingularMatrices) {
  for (const bool tridiagonal : {true, false}) {
    Random random(7);
    const int n = 12;
    std::vector<int> start{0}, rows;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        if (std::abs(i - j) <= 1 || (!tridiagonal && (i + 2 * j) % 5 == 0)) rows.push_back(i);
      }
      start.push_back(static_cast<int>(rows.size()));
    }
    const auto solver = make_unsymmetric_solver(start, rows);
    for (std::size_t i = 0; i < rows.size(); ++i)
      solver->values()[i] = testing::uniform(random, -1, 1);
    const Eigen::MatrixXd full = Eigen::Map<const Eigen::SparseMatrix<double>>(
        n, n, static_cast<int>(rows.size()), start.data(), rows.data(), solver->values());
    ASSERT_TRUE(solver->factor());
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, 1, 3);
    Eigen::VectorXd x = b;
    solver->solve(x.data());
    EXPECT_LT((full * x - b).norm(), 1e-10 * b.norm());
    for (int i = start[3]; i < start[4]; ++i) solver->values()[i] = 0;  // an empty column
    EXPECT_FALSE(solver->factor());
  }
}

TEST(QuasiDefiniteSolver, CountsTheNegativeEigenvaluesOfAQuasiDefiniteMatrix) {
  // [ A  B^T ]
  // [ B  -C  ]  with A, C positive definite has as many negative eigenvalues as C has rows.
  const int n = 6, m = 4;
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n + m, n + m);
  full.topLeftCorner(n, n).diagonal().setLinSpaced(n, 1, 3);
  full.bottomRightCorner(m, m).diagonal().setConstant(-1e-8);
  for (int i = 0; i < m; ++i) {
    full(i, n + i) = full(n + i, i) = 1;
    full(i + 2, n + i) = full(n + i, i + 2) = -1;
  }
  SymmetricPattern pattern;
  pattern.n = n + m;
  pattern.column_start.push_back(0);
  std::vector<double> values;
  for (int j = 0; j < n + m; ++j) {
    for (int i = 0; i <= j; ++i) {
      if (i == j || full(i, j) != 0) {
        pattern.row_index.push_back(i);
        values.push_back(full(i, j));
      }
    }
    pattern.column_start.push_back(pattern.entries());
  }
  QuasiDefiniteSolver solver(pattern);
  std::copy(values.begin(), values.end(), solver.values());
  ASSERT_TRUE(solver.factor());
  EXPECT_EQ(solver.negative_pivots(), m);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(n + m);
  Eigen::VectorXd x = b;
  solver.solve(x.data());
  EXPECT_LT((full * x - b).norm(), 1e-9);
}

}  // namespace
}  // namespace inextensible
