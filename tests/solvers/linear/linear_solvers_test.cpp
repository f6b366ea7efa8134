// Linear solvers on the matrices of random graphs, where constraints_test.cpp has those of grids:
// residuals, inertia, singularity, and ICD's saddle-point system against its dense form.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/linear/lu.h"
#include "solvers/linear/mixed_cholesky.h"
#include "solvers/linear/multifrontal_cholesky.h"
#include "solvers/linear/spd_solvers.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/systems/chain_kkt.h"
#include "solvers/systems/kkt_system.h"
#include "solvers/systems/projected_cg.h"
#include "solvers/systems/schur_complement.h"
#include "support/random_graph.h"

namespace inextensible {
namespace {

using testing::Random;
using testing::random_graph;
constexpr std::uint64_t seeds = 20;
const std::vector<std::string> general_solvers = {"multifrontal", "cholmod_simplicial",
                                                  "cholmod_supernodal"};

Eigen::MatrixXd dense_symmetric(const SymmetricPattern& pattern, const double* values) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
  for (int j = 0; j < pattern.n; ++j) {
    for (int i = pattern.column_start[j]; i < pattern.column_start[j + 1]; ++i) {
      const int row = pattern.row_index[i];
      matrix(row, j) = matrix(j, row) = values[i];
    }
  }
  return matrix;
}

// Normwise backward error of x as a solution of A x = b: below n eps whatever the conditioning.
double backward_error(const Eigen::MatrixXd& a, const Eigen::VectorXd& x,
                      const Eigen::VectorXd& b) {
  return (a * x - b).norm() / (a.norm() * x.norm() + b.norm());
}

TEST(SpdSolver, IsBackwardStableOnGraphsOfUnequalMassesInTheFillReducingOrder) {
  for (const std::string& name : general_solvers) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      Random random(seed);
      const auto graph = random_graph(random, 60, 40, 5, 1e-4);
      const EdgeConstraints edges(*graph.problem, 0.01, elimination_order(*graph.problem));
      const SchurComplement schur(edges, 60, triangle_of(name));
      Eigen::Matrix3Xd u(3, edges.count());
      edges.gradient(graph.x, u);
      const auto solver = make_spd_solver(name, schur.pattern());
      schur.assemble(u, solver->values());
      const Eigen::MatrixXd matrix = dense_symmetric(schur.pattern(), solver->values());
      ASSERT_TRUE(solver->factor());
      for (int right_side = 0; right_side < 3; ++right_side) {
        const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(
            matrix.rows(), [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
        Eigen::VectorXd x = b;
        solver->solve(x.data());
        EXPECT_LT(backward_error(matrix, x, b), 1e-13);
      }
    }
  }
}

// Random lower patterns in any order, no postorder of their trees: diagonally dominant, with one
// dense row in the middle.
template <class Real>
void expect_any_order_to_agree_with_a_dense_factorization(double tolerance) {
  for (std::uint64_t seed = 0; seed < 5 * seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int n = 1 + static_cast<int>(seed % 60);
    SymmetricPattern pattern{n, SymmetricPattern::Triangle::lower, {0}, {}};
    for (int j = 0; j < n; ++j) {
      for (int i = j; i < n; ++i) {
        if (i == j || i == n / 2 || testing::uniform(random, 0, 1) < 0.1)
          pattern.row_index.push_back(i);
      }
      pattern.column_start.push_back(pattern.entries());
    }
    MultifrontalCholesky<Real> solver(pattern);
    Eigen::VectorXd sum = Eigen::VectorXd::Ones(n);  // of absolute values beside the diagonal
    for (int j = 0; j < n; ++j) {
      for (int e = pattern.diagonal(j) + 1; e < pattern.column_start[j + 1]; ++e) {
        solver.values()[e] = testing::uniform(random, -1, 1);
        sum[j] += std::abs(solver.values()[e]);
        sum[pattern.row_index[e]] += std::abs(solver.values()[e]);
      }
    }
    for (int j = 0; j < n; ++j) solver.values()[pattern.diagonal(j)] = sum[j];
    const Eigen::MatrixXd matrix = dense_symmetric(pattern, solver.values());
    ASSERT_TRUE(solver.factor());
    EXPECT_EQ(solver.failed_column(), -1);
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1, 2);
    const Eigen::VectorXd expected = matrix.ldlt().solve(x);
    solver.solve(x.data());
    EXPECT_LT((x - expected).norm(), tolerance * expected.norm());
    // Of whatever magnitude.
    Eigen::VectorXd large = 1e60 * Eigen::VectorXd::LinSpaced(n, -1, 2);
    solver.solve(large.data());
    EXPECT_LT((large - 1e60 * expected).norm(), tolerance * large.norm());
    // A negative diagonal entry is the first pivot to fail: those before it do not see it.
    const int bad = static_cast<int>(seed / 7) % n;
    solver.values()[pattern.diagonal(bad)] = -1;
    EXPECT_FALSE(solver.factor());
    EXPECT_EQ(solver.failed_column(), bad);
  }
}

TEST(MultifrontalCholesky, TakesAnyOrderAndAgreesWithADenseFactorization) {
  expect_any_order_to_agree_with_a_dense_factorization<double>(1e-13);
}

TEST(MultifrontalCholesky, InSinglePrecisionAgreesToSixDigits) {
  expect_any_order_to_agree_with_a_dense_factorization<float>(1e-5);
}

// A pivot of 1e-6 of its diagonal entry is noise in single precision.
TEST(MultifrontalCholesky, InSinglePrecisionRefusesPivotsWithoutDigits) {
  MultifrontalCholesky<float> solver({2, SymmetricPattern::Triangle::lower, {0, 2, 3}, {0, 1, 1}});
  for (const double pivot : {1e-3, 1e-6, 0.0, -1e-6}) {
    const double values[] = {1, 1, 1 + pivot};
    std::copy(values, values + 3, solver.values());
    EXPECT_EQ(solver.factor(), pivot == 1e-3) << pivot;
  }
}

// What is left of a refused matrix, NaN included, must not reach the next one: fronts share memory.
TEST(MultifrontalCholesky, ForgetsAMatrixThatItRefused) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto graph = random_graph(random, 60, 40, 5, 1e-2);
    const EdgeConstraints edges(*graph.problem, 0.01, elimination_order(*graph.problem));
    const SchurComplement schur(edges, 60, SymmetricPattern::Triangle::lower);
    Eigen::Matrix3Xd u(3, edges.count());
    edges.gradient(graph.x, u);
    MultifrontalCholesky<double> used(schur.pattern()), fresh(schur.pattern());
    for (int bad = edges.count() - 1; bad > 0; bad /= 2) {
      schur.assemble(u, used.values());
      const int diagonal = schur.pattern().diagonal(bad);
      used.values()[diagonal] = std::numeric_limits<double>::quiet_NaN();
      EXPECT_FALSE(used.factor());
      used.values()[diagonal] = -std::numeric_limits<double>::infinity();
      EXPECT_FALSE(used.factor());
    }
    schur.assemble(u, used.values());
    schur.assemble(u, fresh.values());
    ASSERT_TRUE(used.factor() && fresh.factor());
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(edges.count(), -1, 2), y = x;
    used.solve(x.data());
    fresh.solve(y.data());
    EXPECT_EQ(x, y);
  }
}

// Graphs with edges so nearly parallel that single precision has few digits, or none.
TEST(MixedCholesky, KeepsWhatItIsAskedForInWhicheverPrecisionItTakes) {
  int in_double = 0, in_single = 0;
  for (std::uint64_t seed = 0; seed < 5 * seeds; ++seed) {
    for (const double bend : {1.0, 1e-1, 1e-2, 1e-3}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", bend " + std::to_string(bend));
      Random random(seed);
      const auto graph = random_graph(random, 60, 40, 5, 1e-2);
      Positions x = graph.x;
      x.bottomRows(2) *= bend;  // towards a line
      const EdgeConstraints edges(*graph.problem, 0.01, elimination_order(*graph.problem));
      const SchurComplement schur(edges, 60, SymmetricPattern::Triangle::lower);
      Eigen::Matrix3Xd u(3, edges.count());
      edges.gradient(x, u);
      MixedCholesky solver(schur.pattern());
      MultifrontalCholesky<double> exact(schur.pattern());
      schur.assemble(u, solver.values());
      schur.assemble(u, exact.values());
      ASSERT_EQ(solver.factor(), exact.factor());
      const Eigen::MatrixXd matrix = dense_symmetric(schur.pattern(), solver.values());
      for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
        const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(
            matrix.rows(), [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
        Eigen::VectorXd found = b;
        ASSERT_TRUE(solver.solve_within(tolerance, found.data()));
        EXPECT_LE((matrix * found - b).norm(),
                  tolerance * b.norm() + 1e-14 * matrix.norm() * found.norm());
        ++(solver.in_double_precision() ? in_double : in_single);
      }
    }
  }
  EXPECT_GT(in_double, 0);
  EXPECT_GT(in_single, 0);
}

// A positive diagonal does not make a matrix positive definite: [1 2; 2 1] has eigenvalue -1.
TEST(SpdSolver, RefusesAnIndefiniteMatrixWithAPositiveDiagonal) {
  for (const char* name : {"tridiagonal", "cholmod_simplicial", "cholmod_supernodal",
                           "multifrontal", "multifrontal_mixed"}) {
    SCOPED_TRACE(name);
    SymmetricPattern pattern;
    pattern.n = 3;
    pattern.triangle = triangle_of(name);
    if (pattern.triangle == SymmetricPattern::Triangle::upper) {
      pattern.column_start = {0, 1, 3, 5};
      pattern.row_index = {0, 0, 1, 1, 2};
    } else {
      pattern.column_start = {0, 2, 4, 5};
      pattern.row_index = {0, 1, 1, 2, 2};
    }
    const auto solver = make_spd_solver(name, pattern);
    const auto fill = [&](double off_diagonal) {
      for (int j = 0; j < 3; ++j) {
        for (int i = pattern.column_start[j]; i < pattern.column_start[j + 1]; ++i) {
          solver->values()[i] = pattern.row_index[i] == j ? 1 : off_diagonal;
        }
      }
    };
    fill(0.7);  // eigenvalues 1, 1 +- 0.7 sqrt(2): the least is 0.01
    EXPECT_TRUE(solver->factor());
    fill(0.71);  // the least is -0.004
    EXPECT_FALSE(solver->factor());
    fill(2);
    EXPECT_FALSE(solver->factor());
    fill(std::numeric_limits<double>::infinity());
    EXPECT_FALSE(solver->factor());
  }
}

// The upper triangle of a matrix of `rows` blocks along the diagonal and beside it.
SymmetricPattern chain_pattern(int rows, int block) {
  SymmetricPattern pattern{rows * block, SymmetricPattern::Triangle::upper, {0}, {}};
  for (int j = 0; j < pattern.n; ++j) {
    for (int i = std::max(0, j - j % block - block); i <= j; ++i) pattern.row_index.push_back(i);
    pattern.column_start.push_back(pattern.entries());
  }
  return pattern;
}

void write_upper(const SymmetricPattern& pattern, const Eigen::MatrixXd& matrix, double* values) {
  for (int j = 0; j < pattern.n; ++j) {
    for (int e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e)
      values[e] = matrix(pattern.row_index[e], j);
  }
}

struct ChainSolver {
  const char* name;
  int block;
};
const ChainSolver chain_solvers[] = {{"tridiagonal", 1}, {"block_tridiagonal", 3}};

// A sum of positive semidefinite matrices of two blocks each, and a little on the diagonal.
Eigen::MatrixXd random_chain_matrix(Random& random, int rows, int block) {
  Eigen::MatrixXd matrix = 1e-3 * Eigen::MatrixXd::Identity(rows * block, rows * block);
  for (int row = 0; row < rows; ++row) {
    const int size = row + 1 < rows ? 2 * block : block;
    const Eigen::MatrixXd factor = Eigen::MatrixXd::NullaryExpr(
        size, size, [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
    matrix.block(row * block, row * block, size, size) += factor * factor.transpose();
  }
  return matrix;
}

TEST(ChainSolvers, AgreeWithADenseFactorizationAtEveryLength) {
  for (const auto [name, block] : chain_solvers) {
    for (int rows = 1; rows <= 40; ++rows) {  // odd and even: they meet in a row, or between two
      SCOPED_TRACE(std::string(name) + ", rows (and seed) " + std::to_string(rows));
      Random random(static_cast<std::uint64_t>(rows));
      const SymmetricPattern pattern = chain_pattern(rows, block);
      const Eigen::MatrixXd matrix = random_chain_matrix(random, rows, block);
      const auto solver = make_spd_solver(name, pattern);
      write_upper(pattern, matrix, solver->values());
      ASSERT_TRUE(solver->factor());
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(pattern.n, -1, 2);
      const Eigen::VectorXd expected = matrix.llt().solve(b);
      Eigen::VectorXd x = b;
      solver->solve(x.data());
      EXPECT_LT(backward_error(matrix, x, b), 1e-15 * (1 + pattern.n));
      EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
      EXPECT_GT(solver->reciprocal_condition(), 0);
      EXPECT_LE(solver->reciprocal_condition(), 1);
    }
  }
}

// Shifted by a little less, and a little more, than its least eigenvalue, a matrix is and is not
// positive definite; which row shows it depends on the matrix.
TEST(ChainSolvers, TellPositiveDefiniteMatricesFromIndefiniteOnes) {
  for (const auto [name, block] : chain_solvers) {
    for (std::uint64_t seed = 0; seed < 3 * seeds; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      Random random(seed);
      const int rows = 1 + static_cast<int>(seed % 13);
      const SymmetricPattern pattern = chain_pattern(rows, block);
      const Eigen::MatrixXd matrix = random_chain_matrix(random, rows, block);
      const double least =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
              .eigenvalues()[0];
      const auto solver = make_spd_solver(name, pattern);
      const auto factors = [&](double shift) {
        write_upper(pattern,
                    matrix - shift * Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()),
                    solver->values());
        return solver->factor();
      };
      EXPECT_TRUE(factors(0.99 * least));
      EXPECT_FALSE(factors(1.01 * least));
      EXPECT_TRUE(factors(0)) << "a failed factorization must not corrupt the next";
      for (int column = 0; column < pattern.n; ++column) {
        for (const double bad :
             {-1.0, 0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
          double& entry = solver->values()[pattern.diagonal(column)];
          const double kept = std::exchange(entry, bad);
          EXPECT_FALSE(solver->factor()) << "diagonal entry " << column << " is " << bad;
          entry = kept;
        }
      }
    }
  }
}

// A chain of springs that hangs on nothing: its Laplacian is singular, and so nearly that of one
// whose ends are held by weak ones.
TEST(ChainSolvers, RefusePivotsThatLostTheirDigitsWhereToldTo) {
  for (const auto& chain : chain_solvers) {
    const auto& name = chain.name;
    const int block = chain.block;
    for (const int rows : {2, 3, 12, 13}) {
      for (const int held : {0, rows / 2, rows - 1}) {
        SCOPED_TRACE(std::string(name) + ", " + std::to_string(rows) + " rows, held at " +
                     std::to_string(held));
        const SymmetricPattern pattern = chain_pattern(rows, block);
        const auto solver = make_spd_solver(name, pattern);
        solver->set_least_pivot(1e-10);
        const auto factors = [&](double hold) {
          Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
          for (int i = 0; i < pattern.n; ++i) {
            matrix(i, i) = (i >= block) + (i + block < pattern.n) + (i / block == held ? hold : 0);
            if (i >= block) matrix(i - block, i) = -1;
          }
          write_upper(pattern, matrix, solver->values());
          return solver->factor();
        };
        ASSERT_TRUE(factors(1e-6));
        EXPECT_LT(solver->reciprocal_condition(), 1e-5);
        EXPECT_FALSE(factors(1e-12));
        EXPECT_FALSE(factors(0));
      }
    }
  }
}

TEST(ChainSolvers, TakeTheirPatternOnly) {
  EXPECT_THROW(make_spd_solver("tridiagonal", chain_pattern(4, 3)), std::invalid_argument);
  EXPECT_THROW(make_spd_solver("block_tridiagonal", chain_pattern(6, 1)), std::invalid_argument);
  EXPECT_THROW(make_spd_solver("block_tridiagonal", chain_pattern(5, 2)), std::invalid_argument);
  SymmetricPattern lower = chain_pattern(1, 3);
  lower.triangle = SymmetricPattern::Triangle::lower;
  EXPECT_THROW(make_spd_solver("block_tridiagonal", lower), std::invalid_argument);
}

// [1 1; 1 1 + p]: the second pivot is p. A solver refuses it where it keeps too little of its
// diagonal entry, and estimates the condition by it.
TEST(SpdSolver, RefusesPivotsThatLostTheirDigitsWhereToldTo) {
  for (const char* name :
       {"tridiagonal", "cholmod_simplicial", "cholmod_supernodal", "multifrontal"}) {
    SCOPED_TRACE(name);
    const bool upper = triangle_of(name) == SymmetricPattern::Triangle::upper;
    const SymmetricPattern pattern{2, triangle_of(name),
                                   upper ? std::vector<int>{0, 1, 3} : std::vector<int>{0, 2, 3},
                                   upper ? std::vector<int>{0, 0, 1} : std::vector<int>{0, 1, 1}};
    const auto solver = make_spd_solver(name, pattern);
    const auto factors = [&](double p) {
      const double values[] = {1, 1, 1 + p};
      std::copy(values, values + 3, solver->values());
      return solver->factor();
    };
    ASSERT_TRUE(factors(1e-6));
    EXPECT_NEAR(solver->reciprocal_condition(), 1e-6, 1e-12);
    EXPECT_TRUE(factors(1e-12));
    EXPECT_FALSE(factors(0));
    solver->set_least_pivot(1e-10);
    EXPECT_TRUE(factors(1e-9));
    if (std::string_view(name) != "cholmod_supernodal") {
      EXPECT_FALSE(factors(1e-11));
    }
  }
}

// SHAKE's matrix, directions at two positions; a tree that is a path has a tridiagonal one.
TEST(UnsymmetricSolver, IsBackwardStableOnShakesMatrices) {
  for (const bool chain : {true, false}) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE((chain ? "chain, seed " : "graph, seed ") + std::to_string(seed));
      Random random(seed);
      const auto graph =
          chain ? testing::random_mesh(random, 1, 40, 1) : random_graph(random, 40, 25, 3, 1e-2);
      const Problem& problem = *graph.problem;
      const EdgeConstraints edges(problem, 0.01);
      const Positions y = testing::perturbed(random, graph, 0.1);
      Eigen::Matrix3Xd ux(3, edges.count()), uy(3, edges.count());
      edges.gradient(graph.x, ux);
      edges.gradient(y, uy);
      const UnsymmetricSchurComplement schur(edges, problem.vertices());
      const auto solver = make_unsymmetric_solver(schur.column_start, schur.row_index);
      schur.assemble(uy, ux, solver->values());
      const Eigen::MatrixXd matrix = testing::dense_gradient(problem, y) *
                                     testing::inverse_masses3(problem).asDiagonal() *
                                     testing::dense_gradient(problem, graph.x).transpose();
      ASSERT_TRUE(solver->factor());
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(edges.count(), -1, 2);
      Eigen::VectorXd x = b;
      solver->solve(x.data());
      EXPECT_LT(backward_error(matrix, x, b), 1e-12);
    }
  }
}

TEST(UnsymmetricSolver, SeesDependentRowsWithoutAnyZeroColumn) {
  for (const int n : {3, 4}) {  // every entry but the corners of n = 3 (tridiagonal), and full
    std::vector<int> start{0}, rows;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        if (n == 4 || std::abs(i - j) <= 1) rows.push_back(i);
      }
      start.push_back(static_cast<int>(rows.size()));
    }
    const auto solver = make_unsymmetric_solver(start, rows);
    // n = 3: [1 1 0; 1 2 1; 0 1 1], whose middle row is the sum of the others. n = 4: all ones.
    for (int j = 0; j < n; ++j) {
      for (int i = start[j]; i < start[j + 1]; ++i) {
        const int row = rows[i];
        solver->values()[i] = n == 3 && row == 1 && j == 1 ? 2 : 1;
      }
    }
    EXPECT_FALSE(solver->factor()) << "n = " << n;
    solver->values()[0] = std::nan("");
    EXPECT_FALSE(solver->factor()) << "n = " << n;
  }
}

// K over all 3 n coordinates, pinned ones with a unit diagonal: they then decouple.
Eigen::MatrixXd dense_kkt(const Problem& problem, const Positions& x, const Eigen::VectorXd& mu,
                          double mean_mass) {
  const Eigen::Index n3 = 3 * x.cols(), m = mu.size();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n3 + m, n3 + m);
  for (Eigen::Index i = 0; i < n3; ++i) kkt(i, i) = problem.mass()[i / 3] / mean_mass;
  for (Eigen::Index k = 0; k < m; ++k) {
    const auto [a, b] = problem.edges()[k];
    const double curvature = 2 * mu[k] / problem.rest_length()[k];
    for (int axis = 0; axis < 3; ++axis) {
      kkt(3 * a + axis, 3 * a + axis) += curvature;
      kkt(3 * b + axis, 3 * b + axis) += curvature;
      kkt(3 * a + axis, 3 * b + axis) -= curvature;
      kkt(3 * b + axis, 3 * a + axis) -= curvature;
    }
  }
  const Eigen::MatrixXd j = testing::dense_gradient(problem, x);
  kkt.bottomLeftCorner(m, n3) = j;
  kkt.topRightCorner(n3, m) = j.transpose();
  for (const int v : problem.pinned()) {
    for (int axis = 0; axis < 3; ++axis) {
      kkt.row(3 * v + axis).setZero();
      kkt.col(3 * v + axis).setZero();
      kkt(3 * v + axis, 3 * v + axis) = 1;
    }
  }
  return kkt;
}

TEST(KktSystem, SolvesTheDenseSaddlePointSystemAndNoticesTheWrongInertia) {
  int right = 0, wrong = 0;
  for (const auto by : {KktSystem::By::ldlt_first, KktSystem::By::umfpack}) {
    const bool ldlt = by == KktSystem::By::ldlt_first;
    for (const double size : {0.0, 0.02, 1.0}) {  // of the multipliers, of either sign
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        SCOPED_TRACE(std::string(ldlt ? "L D L^T" : "UMFPACK") + ", multipliers " +
                     std::to_string(size) + ", seed " + std::to_string(seed));
        Random random(seed);
        const auto graph =
            seed % 2 ? testing::random_mesh(random, 4, 5, 2) : random_graph(random, 20, 12, 2, 0.1);
        const Problem& problem = *graph.problem;
        const int n = problem.vertices(), m = problem.constraints();
        const EdgeConstraints edges(problem, 0.01);
        Eigen::Matrix3Xd u(3, m);
        edges.gradient(graph.x, u);
        const Eigen::VectorXd mu = Eigen::VectorXd::NullaryExpr(
            m, [&](Eigen::Index) { return size * testing::uniform(random, -1, 1); });
        KktSystem kkt(problem, edges, by);
        WorkCounters work;
        ASSERT_TRUE(kkt.factor(u, mu, nullptr, false, work));
        const Eigen::MatrixXd full = dense_kkt(problem, graph.x, mu, kkt.mean_mass());
        const Eigen::VectorXd eigenvalues =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full, Eigen::EigenvaluesOnly)
                .eigenvalues();
        const bool proper = (eigenvalues.array() < 0).count() == m;
        ++(proper ? right : wrong);
        if (eigenvalues.cwiseAbs().minCoeff() > 1e-6 && ldlt) {
          EXPECT_EQ(kkt.convexified(), !proper);
        }
        Positions r(3, n), p(3, n);
        for (Eigen::Index i = 0; i < r.size(); ++i) r.data()[i] = testing::uniform(random, -1, 1);
        for (const int v : problem.pinned()) r.col(v).setZero();
        const Eigen::VectorXd c = Eigen::VectorXd::NullaryExpr(
            m, [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
        Eigen::VectorXd q(m);
        ASSERT_TRUE(kkt.solve(r, c, p, q, work));
        const Eigen::MatrixXd used =
            kkt.convexified() ? dense_kkt(problem, graph.x, mu.cwiseMax(0), kkt.mean_mass()) : full;
        Eigen::VectorXd solution(3 * n + m), rhs(3 * n + m);
        solution << Eigen::Map<const Eigen::VectorXd>(p.data(), 3 * n), q;
        rhs << Eigen::Map<const Eigen::VectorXd>(r.data(), 3 * n), c;
        EXPECT_LT((used * solution - rhs).norm(), 1e-9 * rhs.norm());
        for (const int v : problem.pinned()) EXPECT_EQ(p.col(v).norm(), 0);
      }
    }
  }
  EXPECT_GT(right, 0) << "the multipliers are too large to test the usual case";
  EXPECT_GT(wrong, 0) << "the multipliers are too small to test the other one";
}

// Some hairs in one problem, their edges in random directions: pinned at one end, somewhere
// between, or nowhere. At rest in random shape, masses log-uniform over three decades.
testing::RandomMesh random_chains(Random& random, int chains) {
  testing::RandomMesh mesh;
  ProblemParts parts;
  for (int chain = 0; chain < chains; ++chain) {
    const int first = static_cast<int>(parts.mass.size());
    const int length = 1 + static_cast<int>(random() % 12);
    const int pin = first + static_cast<int>(random() % 13);
    for (int v = first; v < first + length; ++v) {
      parts.mass.push_back(std::pow(10, testing::uniform(random, -3, 0)));
      if (v == pin) parts.pinned.push_back(v);
      if (v > first) parts.edges.push_back(random() % 2 ? Edge{v - 1, v} : Edge{v, v - 1});
    }
  }
  std::shuffle(parts.edges.begin(), parts.edges.end(), random);
  mesh.x = Positions::NullaryExpr(3, static_cast<Eigen::Index>(parts.mass.size()),
                                  [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
  for (const Edge e : parts.edges)
    parts.rest_length.push_back((mesh.x.col(e.b) - mesh.x.col(e.a)).norm());
  mesh.problem = std::make_shared<const Problem>(std::move(parts));
  return mesh;
}

TEST(ChainKkt, SolvesTheDenseSaddlePointSystemAndNoticesTheWrongInertia) {
  int right = 0, wrong = 0;
  for (const double size : {0.0, 0.02, 1.0}) {  // of the multipliers, of either sign
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE("multipliers " + std::to_string(size) + ", seed " + std::to_string(seed));
      Random random(seed);
      const auto mesh = random_chains(random, 1 + static_cast<int>(seed % 5));
      const Problem& problem = *mesh.problem;
      const int n = problem.vertices(), m = problem.constraints();
      const EdgeConstraints edges(problem, 0.01);
      Eigen::Matrix3Xd u(3, m);
      edges.gradient(mesh.x, u);
      const Eigen::VectorXd mu = Eigen::VectorXd::NullaryExpr(
          m, [&](Eigen::Index) { return size * testing::uniform(random, -1, 1); });
      ChainKkt kkt(problem, edges);
      WorkCounters work;
      ASSERT_TRUE(kkt.factor(u, mu, nullptr, false, work));
      const Eigen::MatrixXd full = dense_kkt(problem, mesh.x, mu, kkt.mean_mass());
      const Eigen::VectorXd eigenvalues =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full, Eigen::EigenvaluesOnly)
              .eigenvalues();
      const bool proper = (eigenvalues.array() < 0).count() == m;
      ++(proper ? right : wrong);
      if (eigenvalues.cwiseAbs().minCoeff() > 1e-6) {
        EXPECT_EQ(kkt.convexified(), !proper);
      }
      EXPECT_EQ(work.factorizations, kkt.convexified() ? 2 : 1);  // none was left to UMFPACK
      Positions r(3, n), p(3, n);
      for (Eigen::Index i = 0; i < r.size(); ++i) r.data()[i] = testing::uniform(random, -1, 1);
      const Eigen::VectorXd c = Eigen::VectorXd::NullaryExpr(
          m, [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
      Eigen::VectorXd q(m);
      ASSERT_TRUE(kkt.solve(r, c, p, q, work));
      const Eigen::MatrixXd used =
          kkt.convexified() ? dense_kkt(problem, mesh.x, mu.cwiseMax(0), kkt.mean_mass()) : full;
      Eigen::VectorXd solution(3 * n + m), rhs(3 * n + m);
      for (const int v : problem.pinned()) {
        EXPECT_EQ(p.col(v).norm(), 0);
        r.col(v).setZero();
      }
      solution << p.reshaped(), q;
      rhs << r.reshaped(), c;
      EXPECT_LT((used * solution - rhs).norm(), 1e-9 * rhs.norm());
    }
  }
  EXPECT_GT(right, 10) << "the multipliers are too large to test the usual case";
  EXPECT_GT(wrong, 10) << "the multipliers are too small to test the other one";
}

TEST(ChainKkt, TakesNoOtherGraphs) {
  ProblemParts parts;
  parts.mass = {1, 1, 1, 1};
  parts.edges = {{0, 1}, {1, 2}, {3, 2}};
  parts.rest_length = {1, 1, 1};
  EXPECT_TRUE(ChainKkt::fits(Problem(parts)));
  parts.pinned = {0, 3};  // a chain between two pins
  EXPECT_FALSE(ChainKkt::fits(Problem(parts)));
  EXPECT_THROW(ChainKkt(Problem(parts), EdgeConstraints(Problem(parts), 0.01)),
               std::invalid_argument);
  parts.pinned = {2};
  EXPECT_TRUE(ChainKkt::fits(Problem(parts)));
  parts.edges[2] = {1, 3};  // not the next one
  EXPECT_FALSE(ChainKkt::fits(Problem(parts)));
  parts.edges[2] = {2, 1};  // twice
  EXPECT_FALSE(ChainKkt::fits(Problem(parts)));
}

// On every step J p = c holds; where M + H is positive definite on the null space of J, the system
// is solved.
TEST(ProjectedCg, SolvesTheSaddlePointSystemAndKeepsTheConstraintsWhereItIsIndefinite) {
  int right = 0, wrong = 0;
  for (const double size : {0.0, 0.02, 1.0, 30.0}) {  // of the multipliers
    for (const double lowest : {0.0, -1.0}) {         // tension alone; of either sign
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        SCOPED_TRACE("multipliers " + std::to_string(size) + " from " + std::to_string(lowest) +
                     ", seed " + std::to_string(seed));
        Random random(seed);
        const auto graph =
            seed % 2 ? testing::random_mesh(random, 4, 5, 2) : random_graph(random, 20, 12, 2, 0.1);
        const Problem& problem = *graph.problem;
        const int n = problem.vertices(), m = problem.constraints();
        const EdgeConstraints edges(problem, 0.01, elimination_order(problem));
        Eigen::Matrix3Xd u(3, m);
        edges.gradient(graph.x, u);
        const Eigen::VectorXd mu = Eigen::VectorXd::NullaryExpr(
            m, [&](Eigen::Index) { return size * testing::uniform(random, lowest, 1); });
        ProjectedCg cg(problem, edges, {1e-12, 500, "multifrontal"});
        WorkCounters work;
        ASSERT_TRUE(cg.factor(u, mu, nullptr, false, work));
        Positions r(3, n), p(3, n);
        for (Eigen::Index i = 0; i < r.size(); ++i) r.data()[i] = testing::uniform(random, -1, 1);
        for (const int v : problem.pinned()) r.col(v).setZero();
        const Eigen::VectorXd c = Eigen::VectorXd::NullaryExpr(
            m, [&](Eigen::Index) { return testing::uniform(random, -1, 1); });
        Eigen::VectorXd q(m), rate(m);
        ASSERT_TRUE(cg.solve(r, c, p, q, work));
        edges.rate(u, p, rate);
        EXPECT_LT((rate - c).norm(), 1e-8 * c.norm());
        for (const int v : problem.pinned()) EXPECT_EQ(p.col(v).norm(), 0);

        Eigen::VectorXd natural_mu(m), natural_q(m), natural_c(m);  // in the problem's order
        for (int k = 0; k < m; ++k) {
          natural_mu[edges.problem_edge(k)] = mu[k];
          natural_q[edges.problem_edge(k)] = q[k];
          natural_c[edges.problem_edge(k)] = c[k];
        }
        const Eigen::MatrixXd full = dense_kkt(problem, graph.x, natural_mu, cg.mean_mass());
        const Eigen::VectorXd eigenvalues =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full, Eigen::EigenvaluesOnly)
                .eigenvalues();
        const bool proper = (eigenvalues.array() < 0).count() == m;
        ++(proper ? right : wrong);
        if (!proper) continue;
        EXPECT_FALSE(cg.convexified());
        Eigen::VectorXd solution(3 * n + m), rhs(3 * n + m);
        solution << Eigen::Map<const Eigen::VectorXd>(p.data(), 3 * n), natural_q;
        rhs << Eigen::Map<const Eigen::VectorXd>(r.data(), 3 * n), natural_c;
        EXPECT_LT((full * solution - rhs).norm(),
                  1e-8 * (rhs.norm() + full.norm() * solution.norm()));
      }
    }
  }
  EXPECT_GT(right, 0) << "no system of a minimum";
  EXPECT_GT(wrong, 0) << "no indefinite one";
}

}  // namespace
}  // namespace inextensible
