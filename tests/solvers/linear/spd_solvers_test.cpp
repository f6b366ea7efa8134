// What every linear solver of the list promises, and some beyond that, against dense algebra.
#include <Eigen/Dense>
#include <unsupported/Eigen/KroneckerProduct>

#include "solvers/linear/multifrontal_cholesky.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, testing::Random, testing::random_matrix, testing::uniform;
using Triangle = SymmetricPattern::Triangle;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

MatrixXd schur_complement(const Problem& problem, const Positions& x) {
  return testing::dense_gradient(problem, x) * testing::dense_moves(problem, x);
}

// Sparse, with couplings of all strengths.
MatrixXd random_spd(Random& random, int n) {
  MatrixXd b = MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j) {
    b(j, j) = uniform(random, 0.1, 1);
    for (int k = 0; k < 2; ++k)
      b(static_cast<int>(uniform(random, 0, n)), j) += uniform(random, -1, 1);
  }
  return b * b.transpose();
}

// A sum of positive semidefinite matrices of two blocks each, and a little on the diagonal.
MatrixXd random_chain(Random& random, int rows, int block) {
  MatrixXd matrix = 1e-3 * MatrixXd::Identity(rows * block, rows * block);
  for (int row = 0; row < rows; ++row) {
    const int size = row + 1 < rows ? 2 * block : block;
    const MatrixXd factor = random_matrix(random, size, size);
    matrix.block(row * block, row * block, size, size) += factor * factor.transpose();
  }
  return matrix;
}

SymmetricPattern chain_pattern(int rows, int block, Triangle triangle = Triangle::upper) {
  Pairs links;
  for (int i = 1; i < rows; ++i) links.emplace_back(i - 1, i);
  return in_blocks(pattern_of(rows, links, triangle), block);
}

// The entries that are not exactly 0.
SymmetricPattern pattern_of(const MatrixXd& matrix, Triangle triangle) {
  Pairs pairs;
  for (int j = 0; j < matrix.cols(); ++j)
    for (int i = 0; i < j; ++i)
      if (matrix(i, j) != 0) pairs.emplace_back(i, j);
  return pattern_of(static_cast<int>(matrix.rows()), pairs, triangle);
}

void write(const MatrixXd& matrix, const SymmetricPattern& pattern, SpdSolver& solver) {
  for (int j = 0; j < pattern.n; ++j)
    for (int e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e)
      solver.values()[e] = matrix(pattern.row_index[e], j);
}

bool mixed(const SpdSolverRow& row) { return row.precision == Precision::mixed; }

struct System {
  MatrixXd dense;
  SymmetricPattern pattern;
  std::unique_ptr<SpdSolver> solver;

  System(const SpdSolverRow& row, MatrixXd matrix, SymmetricPattern its_pattern)
      : dense(std::move(matrix)),
        pattern(std::move(its_pattern)),
        solver(make_spd_solver(row.name, pattern)) {
    write(dense, pattern, *solver);
  }
  System(const SpdSolverRow& row, const MatrixXd& matrix)
      : System(row, matrix, pattern_of(matrix, row.triangle)) {}
  bool factor_shifted(double shift) {
    write(dense - shift * MatrixXd::Identity(pattern.n, pattern.n), pattern, *solver);
    return solver->factor();
  }
};

// Chains of any length, odd and even; for solvers of any pattern also matrices of graphs with
// unequal masses, of cloth, and without a meaning, in either kind of order.
System random_system(const SpdSolverRow& row, std::uint64_t seed) {
  Random random(seed);
  if (row.takes != Takes::any) {
    const int rows = 1 + static_cast<int>(seed % 40),
              block = row.takes == Takes::tridiagonal ? 1 : 3;
    return {row, random_chain(random, rows, block), chain_pattern(rows, block)};
  }
  const auto kind = seed % 4;
  // Mixed precision goes by pivots, which tell the condition of a Schur complement only.
  const bool meaningless = kind == 2 && !mixed(row);
  const auto mesh = kind == 0 ? testing::random_graph(random, 40, 25, 3, 1e-4)
                              : testing::random_mesh(random, 5, 7, 2);
  MatrixXd matrix = meaningless
                        ? random_spd(random, 1 + static_cast<int>(random() % 60))
                        : schur_complement(*mesh.problem, testing::perturbed(random, mesh, 0.1));
  if (seed % 8 < 4) {
    const std::vector<int> order = fill_reducing_order(pattern_of(matrix, Triangle::upper));
    matrix = MatrixXd(matrix(order, order));
  }
  return {row, matrix};
}

class SpdSolvers : public ::testing::TestWithParam<SpdSolverRow> {};
INSTANTIATE_TEST_SUITE_P(All, SpdSolvers, ::testing::ValuesIn(spd_solvers()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(SpdSolvers, SolveToTheToleranceAskedForWhateverTheMagnitude) {
  const SpdSolverRow& row = GetParam();
  testing::for_seeds(60, [&](testing::Random& random, std::uint64_t seed) {
    System system = random_system(row, seed);
    for (int round = 0; round < 2; ++round) {  // the same pattern, other values
      system.dense.diagonal().array() += 0.1 * round;
      ASSERT_TRUE(system.factor_shifted(0));
      EXPECT_GE(system.solver->factor_nonzeros(), static_cast<double>(system.pattern.n));
      for (const double tolerance : {1e-1, 1e-4, 1e-10, SpdSolver::tightest}) {
        const double size = tolerance == 1e-10 ? 1e60 : 1;
        const VectorXd b = size * random_matrix(random, system.pattern.n, 1);
        VectorXd x = b;
        ASSERT_TRUE(system.solver->solve_within(tolerance, x.data()));
        const double rounding = 1e-13 * (system.dense.norm() * x.norm() + b.norm());
        EXPECT_LE((system.dense * x - b).norm(),
                  rounding + (mixed(row) ? 1.01 * tolerance * b.norm() : 0));
      }
    }
  });
}

TEST_P(SpdSolvers, SolveForThreeCoordinatesAtOnce) {
  testing::for_seeds(30, [&](testing::Random& random, std::uint64_t seed) {
    System system = random_system(GetParam(), seed);
    ASSERT_TRUE(system.solver->factor());
    const MatrixXd b = random_matrix(random, system.pattern.n, 3);
    Eigen::Matrix4Xd x = Eigen::Matrix4Xd::Zero(4, system.pattern.n);
    x.topRows(3) = b.transpose();
    system.solver->solve_coordinates(x);
    const MatrixXd found = x.topRows(3).transpose();
    const double rounding = mixed(GetParam()) ? 1e-5 : 1e-13;
    EXPECT_LE((system.dense * found - b).norm(),
              rounding * (system.dense.norm() * found.norm() + b.norm()));
  });
}

// A positive diagonal is not enough. What is left of a refused matrix must not reach the next one.
TEST_P(SpdSolvers, RefuseWhatIsNotPositiveDefiniteAndForgetIt) {
  testing::for_seeds(30, [](Random&, std::uint64_t seed) {
    System system = random_system(GetParam(), seed);
    const int n = system.pattern.n;
    const VectorXd b = VectorXd::LinSpaced(n, -1, 2);
    const auto solution = [&] {
      VectorXd x = b;
      EXPECT_TRUE(system.factor_shifted(0));
      system.solver->solve(x.data());
      return x;
    };
    const VectorXd fresh = solution();
    const double least = system.dense.selfadjointView<Eigen::Lower>().eigenvalues()[0];
    EXPECT_TRUE(system.factor_shifted(0.99 * least));
    EXPECT_FALSE(system.factor_shifted(1.01 * least));
    for (const int column : {0, n / 2, n - 1})
      for (const double bad : {-1.0, 0.0, nan, -infinity, infinity}) {
        write(system.dense, system.pattern, *system.solver);
        system.solver->values()[system.pattern.diagonal(column)] = bad;
        EXPECT_FALSE(system.solver->factor()) << "diagonal entry " << column << " is " << bad;
      }
    EXPECT_EQ(solution(), fresh);
  });
}

// A chain of springs that hangs on nothing: its Laplacian is singular, and so nearly that of one
// that is held by a weak spring. (The supernodal code takes any positive pivot.)
TEST_P(SpdSolvers, RefusePivotsThatLostTheirDigitsWhereToldTo) {
  const SpdSolverRow& row = GetParam();
  if (std::string_view(row.name) == "cholmod_supernodal") return;
  const int block = row.takes == Takes::block_tridiagonal ? 3 : 1;
  for (const int rows : {2, 3, 12, 13})
    for (const int held : {0, rows / 2, rows - 1}) {
      SCOPED_TRACE(std::to_string(rows) + " rows, held at " + std::to_string(held));
      const auto solver = [&](double hold, double least) {
        MatrixXd links = MatrixXd::Zero(rows, rows);
        links.diagonal(1).setConstant(-1);
        links.diagonal(-1).setConstant(-1);
        links.diagonal() = VectorXd(-links.rowwise().sum());
        links(held, held) += hold;
        System system(row, Eigen::kroneckerProduct(links, MatrixXd::Identity(block, block)),
                      chain_pattern(rows, block, row.triangle));
        system.solver->set_least_pivot(least);
        return std::move(system.solver);
      };
      EXPECT_TRUE(solver(1e-6, 1e-10)->factor());
      EXPECT_TRUE(solver(1e-12, 0)->factor());
      EXPECT_FALSE(solver(1e-12, 1e-10)->factor());
      EXPECT_FALSE(solver(0, 1e-10)->factor());
    }
}

TEST(ChainSolvers, TakeTheirPatternOnly) {
  EXPECT_THROW(make_spd_solver("tridiagonal", chain_pattern(4, 3)), std::invalid_argument);
  EXPECT_THROW(make_spd_solver("block_tridiagonal", chain_pattern(6, 1)), std::invalid_argument);
  EXPECT_THROW(make_spd_solver("block_tridiagonal", chain_pattern(5, 2)), std::invalid_argument);
  EXPECT_THROW(make_spd_solver("block_tridiagonal", chain_pattern(1, 3, Triangle::lower)),
               std::invalid_argument);
}

// ---- The multifrontal factorization in single precision ----

// Graphs with edges so nearly parallel that single precision has few digits, or none.
TEST(MixedCholesky, KeepsWhatItIsAskedForInWhicheverPrecisionItTakes) {
  int solved[2] = {0, 0};
  testing::for_seeds(50, [&](testing::Random& random, std::uint64_t seed) {
    for (const double bend : {1.0, 1e-1, 1e-2, 1e-3}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", bend " + std::to_string(bend));
      const auto graph = testing::random_graph(random, 60, 40, 5, 1e-2);
      Positions x = graph.x;
      x.bottomRows(2) *= bend;  // towards a line
      const MatrixXd matrix = schur_complement(*graph.problem, x);
      const SymmetricPattern pattern = pattern_of(matrix, Triangle::lower);
      MixedCholesky solver(pattern);
      MultifrontalCholesky<double> exact(pattern);
      write(matrix, pattern, solver);
      write(matrix, pattern, exact);
      ASSERT_EQ(solver.factor(), exact.factor());
      for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
        const VectorXd b = random_matrix(random, pattern.n, 1);
        VectorXd found = b;
        ASSERT_TRUE(solver.solve_within(tolerance, found.data()));
        EXPECT_LE((matrix * found - b).norm(),
                  tolerance * b.norm() + 1e-14 * matrix.norm() * found.norm());
        ++solved[solver.in_double_precision()];
      }
    }
  });
  EXPECT_GT(solved[false], 0);
  EXPECT_GT(solved[true], 0);
}

}  // namespace
}  // namespace inextensible
