// Conjugate gradients along lines and the hybrid with a factorization: against dense algebra, their
// lines against the yarns of a cloth, honesty about matrices that are not positive definite, and
// fast projection with them against fast projection with a factorization.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solvers/linear/hybrid.h"
#include "solvers/linear/spd_solvers.h"
#include "solvers/registry.h"
#include "solvers/systems/schur_complement.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using testing::perturbed;
using testing::Random;
using testing::random_mesh;
using testing::uniform;
constexpr std::uint64_t examples = 20;

// The upper triangle of a dense matrix, entries that are exactly 0 left out but on the diagonal.
SymmetricPattern pattern_of(const Eigen::MatrixXd& matrix) {
  SymmetricPattern pattern;
  pattern.n = static_cast<int>(matrix.rows());
  pattern.column_start.push_back(0);
  for (int j = 0; j < pattern.n; ++j) {
    for (int i = 0; i <= j; ++i) {
      if (i == j || matrix(i, j) != 0) pattern.row_index.push_back(i);
    }
    pattern.column_start.push_back(static_cast<int>(pattern.row_index.size()));
  }
  return pattern;
}

void write(const Eigen::MatrixXd& matrix, const SymmetricPattern& pattern, SpdSolver& solver) {
  double* value = solver.values();
  for (int j = 0; j < pattern.n; ++j) {
    for (int i = pattern.column_start[j]; i < pattern.column_start[j + 1]; ++i)
      *value++ = matrix(pattern.row_index[i], j);
  }
}

Eigen::VectorXd random_vector(Random& random, Eigen::Index n) {
  return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return uniform(random, -1, 1); });
}

// Sparse, positive definite, with couplings of all strengths.
Eigen::MatrixXd random_spd(Random& random, int n) {
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j) {
    b(j, j) = uniform(random, 0.1, 1);
    for (int k = 0; k < 2; ++k)
      b(static_cast<int>(uniform(random, 0, n)), j) += uniform(random, -1, 1);
  }
  return b * b.transpose();
}

Eigen::MatrixXd dense_schur(const Problem& problem, const Positions& x) {
  const Eigen::MatrixXd j = testing::dense_gradient(problem, x);
  return j * testing::inverse_masses3(problem).asDiagonal() * j.transpose();
}

TEST(LineCg, SolvesRandomMatricesToTheToleranceAskedFor) {
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int n = 1 + static_cast<int>(uniform(random, 0, 60));
    const Eigen::MatrixXd matrix = random_spd(random, n);
    const SymmetricPattern pattern = pattern_of(matrix);
    LineCgSolver solver(pattern);
    write(matrix, pattern, solver);
    ASSERT_TRUE(solver.factor());
    for (const double tolerance : {1e-1, 1e-4, 1e-10}) {
      const Eigen::VectorXd b = random_vector(random, n);
      Eigen::VectorXd x = b;
      ASSERT_TRUE(solver.solve_within(tolerance, x.data()));
      // The recursive residual drifts from the true one by rounding times the condition.
      EXPECT_LE((matrix * x - b).norm(),
                1.01 * tolerance * b.norm() + 1e-13 * matrix.norm() * x.norm());
    }
  }
}

TEST(LineCg, SolvesASystemOfLinesAloneWithoutIterating) {
  Random random(1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(12, 12);
  for (int i = 0; i < 12; ++i) {
    matrix(i, i) = 2.1;
    if (i != 0 && i != 7) matrix(i, i - 1) = matrix(i - 1, i) = -1;  // two lines
  }
  const SymmetricPattern pattern = pattern_of(matrix);
  LineCgSolver solver(pattern);
  write(matrix, pattern, solver);
  ASSERT_TRUE(solver.factor());
  EXPECT_EQ(solver.lines(), 2);
  const Eigen::VectorXd b = random_vector(random, 12);
  Eigen::VectorXd x = b;
  solver.solve(x.data());
  EXPECT_LT((x - matrix.ldlt().solve(b)).norm(), 1e-14 * x.norm() * 12);
  EXPECT_EQ(solver.iterations(), 0);
}

TEST(LineCg, FindsTheYarnsOfACrumpledClothAndAgreesWithDenseAlgebra) {
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto mesh = random_mesh(random, 7, 9, 0);
    const EdgeConstraints edges(*mesh.problem, 0.01);
    const SchurComplement schur(edges, mesh.problem->vertices(), SymmetricPattern::Triangle::upper);
    Eigen::Matrix3Xd u(3, edges.count());
    edges.gradient(mesh.x, u);
    LineCgSolver solver(schur.pattern());
    schur.assemble(u, solver.values());
    ASSERT_TRUE(solver.factor());
    // Unequal masses and angles break yarns now and then, never into single edges.
    EXPECT_GE(solver.lines(), 7 + 9 - 4);
    EXPECT_LE(solver.lines(), 3 * (7 + 9));

    const Eigen::MatrixXd matrix = dense_schur(*mesh.problem, mesh.x);
    const Eigen::VectorXd b = random_vector(random, edges.count());
    Eigen::VectorXd x = b;
    ASSERT_TRUE(solver.solve_within(1e-12, x.data()));
    EXPECT_LT((matrix * x - b).norm(), 1e-10 * b.norm());
    const Eigen::VectorXd expected = matrix.ldlt().solve(b);
    EXPECT_LT((x - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(LineCg, LinesAreASymmetricPositiveDefinitePreconditionerAndThoseEliminatedAreIndependent) {
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int n = 40;
    const Eigen::MatrixXd matrix = random_spd(random, n);
    const SymmetricPattern pattern = pattern_of(matrix);
    LineCgSolver solver(pattern);
    write(matrix, pattern, solver);
    ASSERT_TRUE(solver.factor());
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(n, n);
    for (int j = 0; j < n; ++j) solver.solve_lines(inverse.col(j).data());
    EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-12 * inverse.norm());
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(inverse).eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), 0);
    // What it inverts is the matrix itself where it has an entry; among eliminated rows, all of it.
    const Eigen::MatrixXd lines = inverse.inverse();
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const bool whole = solver.eliminated(i) && solver.eliminated(j);
        if (whole || i == j || std::abs(lines(i, j)) > 1e-6 * lines.norm()) {
          EXPECT_NEAR(lines(i, j), matrix(i, j), 1e-9 * matrix.norm());
        }
      }
    }
  }
}

// Weak couplings, none of which makes a line; positive definite without, indefinite with them.
Eigen::MatrixXd indefinite(int n) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(n, n, -0.2);
  matrix.diagonal().setOnes();
  return matrix;
}

TEST(LineCg, ReportsIndefiniteMatricesByReturnValue) {
  const Eigen::MatrixXd matrix = indefinite(10);
  const SymmetricPattern pattern = pattern_of(matrix);
  for (const char* name : {"line_cg", "hybrid"}) {
    SCOPED_TRACE(name);
    const auto solver = make_spd_solver(name, pattern);
    write(matrix, pattern, *solver);
    ASSERT_TRUE(solver->factor());  // every line is positive definite
    Eigen::VectorXd x = Eigen::VectorXd::Ones(10);
    EXPECT_FALSE(solver->solve_within(1e-6, x.data()));

    solver->values()[0] = -1;  // and now a line is not
    EXPECT_FALSE(solver->factor());
    solver->values()[0] = std::nan("");
    EXPECT_FALSE(solver->factor());
  }
}

TEST(LineCg, ReportsThatIterationsDidNotSuffice) {
  Random random(3);
  const Eigen::MatrixXd matrix = random_spd(random, 50);
  const SymmetricPattern pattern = pattern_of(matrix);
  LineCgSolver solver(pattern);
  write(matrix, pattern, solver);
  ASSERT_TRUE(solver.factor());
  solver.set_most_iterations(2);
  Eigen::VectorXd x = random_vector(random, 50);
  EXPECT_FALSE(solver.solve_within(1e-12, x.data()));
  EXPECT_EQ(solver.iterations(), 2);
}

// J W J^T of n x n vertices, sums of two curves in the plane: the angle between warp and weft is
// `angle`, but for random bends of either.
Eigen::MatrixXd sheared(Random& random, int n, double angle, double bend) {
  Positions warp = Positions::Zero(3, n), weft = Positions::Zero(3, n);
  for (int i = 1; i < n; ++i) {
    const double p = bend * uniform(random, -1, 1);
    const double q = angle + bend * uniform(random, -1, 1);
    warp.col(i) = warp.col(i - 1) + Eigen::Vector3d(std::cos(p), std::sin(p), 0);
    weft.col(i) = weft.col(i - 1) + Eigen::Vector3d(std::cos(q), std::sin(q), 0);
  }
  ProblemParts parts;
  Positions x(3, n * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int v = i * n + j;
      x.col(v) = warp.col(j) + weft.col(i);
      parts.mass.push_back(1);
      if (j > 0) parts.edges.push_back({v - 1, v});
      if (i > 0) parts.edges.push_back({v - n, v});
    }
  }
  parts.rest_length.assign(parts.edges.size(), 1);
  return dense_schur(Problem(std::move(parts)), x);
}

TEST(Hybrid, FactorsWhereConjugateGradientsAreSlowAndComesBackFromThere) {
  Random random(5);
  const int n = 20;
  const Eigen::MatrixXd easy = sheared(random, n, 1.4, 0.1), hard = sheared(random, n, 0.02, 0.01);
  const SymmetricPattern pattern = pattern_of(easy);
  HybridSpdSolver solver(pattern);
  const auto solve = [&](const Eigen::MatrixXd& matrix) {
    write(matrix, pattern, solver);
    ASSERT_TRUE(solver.factor());
    const Eigen::VectorXd b = random_vector(random, matrix.rows());
    Eigen::VectorXd x = b;
    ASSERT_TRUE(solver.solve_within(1e-8, x.data()));
    EXPECT_LE((matrix * x - b).norm(), 1.1e-8 * b.norm() + 1e-13 * matrix.norm() * x.norm());
  };
  solve(easy);
  EXPECT_FALSE(solver.factors());
  for (int i = 0; i < 200 && !solver.factors(); ++i) solve(hard);
  EXPECT_TRUE(solver.factors());
  const auto iterations = solver.iterations();
  solve(hard);
  EXPECT_EQ(solver.iterations(), iterations);  // conjugate gradients have a rest
  for (int i = 0; i < 200 && solver.factors(); ++i) solve(easy);
  EXPECT_FALSE(solver.factors());
}

TEST(FastProjection, KeepsTheLimitAlikeWithConjugateGradientsAndWithAFactorization) {
  constexpr double limit = 1e-3;
  for (std::uint64_t seed = 0; seed < examples; ++seed) {
    Random random(seed);
    const auto mesh = random_mesh(random, 8, 8, static_cast<int>(seed % 3));
    const Positions candidate = perturbed(random, mesh, 0.05);
    Positions expected = candidate;
    WorkCounters work;
    const auto filter_with = [&](const char* name) {
      return make_velocity_filter("fast_projection", *mesh.problem,
                                  {limit, 1, {{"linear_solver", std::string(name)}}});
    };
    const StepResult exact = filter_with("multifrontal")->apply(mesh.x, 0.01, expected, work);
    ASSERT_TRUE(exact);
    EXPECT_EQ(work.linear_iterations, 0);
    for (const char* name : {"line_cg", "hybrid"}) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Positions x = candidate;
      WorkCounters inexact;
      const StepResult result = filter_with(name)->apply(mesh.x, 0.01, x, inexact);
      ASSERT_TRUE(result);
      EXPECT_GT(inexact.linear_iterations, 0);
      EXPECT_LE(result.iterations, exact.iterations + 2);
      EXPECT_TRUE(EdgeConstraints(*mesh.problem, limit).permissible(x));
      // Both lie within the limit of the manifold; along it, inner residuals add a fraction of the
      // way that the projection goes.
      EXPECT_LT((x - expected).norm(), 0.05 * (candidate - expected).norm());
    }
  }
}

}  // namespace
}  // namespace inextensible
