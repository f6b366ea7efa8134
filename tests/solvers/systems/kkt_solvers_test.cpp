// ICD's saddle-point system in every solver, against its dense form.
#include <Eigen/Dense>
#include <tuple>

#include "solvers/systems/kkt_system.h"
#include "solvers/systems/schur_complement.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, testing::Random, testing::uniform;

// K over all 3 n coordinates, pinned ones with a unit diagonal: they then decouple.
MatrixXd dense_kkt(const Problem& problem, const Positions& x, const VectorXd& mu) {
  const Eigen::Index n3 = 3 * x.cols(), m = mu.size();
  const double mean_mass = problem.total_mass() / problem.vertices();
  MatrixXd kkt = MatrixXd::Zero(n3 + m, n3 + m);
  for (Eigen::Index i = 0; i < n3; ++i) kkt(i, i) = problem.mass()[i / 3] / mean_mass;
  for (Eigen::Index k = 0; k < m; ++k) {
    const auto [a, b] = problem.edges()[k];
    const double curvature = 2 * mu[k] / problem.rest_length()[k];
    for (const auto& [row, column, sign] : {std::tuple(a, a, 1), {b, b, 1}, {a, b, -1}, {b, a, -1}})
      kkt.block<3, 3>(3 * row, 3 * column).diagonal().array() += sign * curvature;
  }
  const MatrixXd j = testing::dense_gradient(problem, x);
  kkt.bottomLeftCorner(m, n3) = j;
  kkt.topRightCorner(n3, m) = j.transpose();
  for (const int v : problem.pinned()) {
    kkt.middleRows<3>(3 * v).setZero();
    kkt.middleCols<3>(3 * v).setZero();
    kkt.block<3, 3>(3 * v, 3 * v).setIdentity();
  }
  return kkt;
}

using Made = std::unique_ptr<KktSolver>;
struct Row {
  const char* name;
  bool chains;         // takes nothing else
  bool solves_all;     // also where M + H is indefinite, by the convex H
  bool tells_inertia;  // leaves negative multipliers out if and only if it is
  double accuracy;     // relative residual
  Made (*make)(const Problem& problem, const EdgeConstraints& edges);
};
const Row rows[] = {{"quasi_definite", false, true, true, 1e-9,
                     [](const Problem& problem, const EdgeConstraints& edges) -> Made {
                       return make_kkt_system(problem, edges);
                     }},
                    {"umfpack", false, true, false, 1e-9,
                     [](const Problem& problem, const EdgeConstraints& edges) -> Made {
                       return make_kkt_system(problem, edges, FactoredBy::umfpack);
                     }},
                    {"block_tridiagonal", true, true, true, 1e-9, make_chain_kkt},
                    {"projected_cg", false, false, false, 1e-8,
                     [](const Problem& problem, const EdgeConstraints& edges) -> Made {
                       return make_projected_cg(problem, edges, {1e-12, 500, "multifrontal"});
                     }}};

class KktSolvers : public ::testing::TestWithParam<Row> {};
INSTANTIATE_TEST_SUITE_P(All, KktSolvers, ::testing::ValuesIn(rows),
                         [](const auto& test) { return std::string(test.param.name); });

// On every step J p = c holds, in an order of edges with little fill.
TEST_P(KktSolvers, SolveTheDenseSaddlePointSystemAndNoticeTheWrongInertia) {
  const Row& row = GetParam();
  int seen[2] = {0, 0};                               // of the wrong inertia, and of the right
  for (const double size : {0.0, 0.02, 1.0, 30.0}) {  // of the multipliers
    if (size > 1 && row.solves_all) continue;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE("multipliers " + std::to_string(size) + ", seed " + std::to_string(seed));
      Random random(seed);
      const auto mesh = row.chains ? testing::random_chains(random, 1 + static_cast<int>(seed % 5))
                        : seed % 2 ? testing::random_mesh(random, 4, 5, 2)
                                   : testing::random_graph(random, 20, 12, 2, 0.1);
      const Problem& problem = *mesh.problem;
      const int n = problem.vertices(), m = problem.constraints();
      const EdgeConstraints edges(problem, 0.01, elimination_order(problem));
      Eigen::Matrix3Xd u(3, m);
      edges.gradient(mesh.x, u);
      const auto random_vector = [&](int length, double low) {
        return VectorXd(VectorXd::NullaryExpr(length, [&] { return uniform(random, low, 1); }));
      };
      const VectorXd mu = size * random_vector(m, seed % 4 < 2 ? 0 : -1);  // tension alone, or not
      const Made kkt = row.make(problem, edges);
      WorkCounters work;
      ASSERT_TRUE(kkt->factor(u, mu, nullptr, false, work));
      Positions r = random_vector(3 * n, -1).reshaped(3, n), p(3, n);
      const VectorXd c = random_vector(m, -1);
      VectorXd q(m), rate(m);
      ASSERT_TRUE(kkt->solve(r, c, p, q, work));
      edges.rate(u, p, rate);
      EXPECT_LT((rate - c).norm(), 1e-8 * (c.norm() + 1e-6 * p.norm()));
      for (const int v : problem.pinned()) {
        EXPECT_EQ(p.col(v).norm(), 0);
        r.col(v).setZero();
      }

      const auto in_order_of_problem = [&](const VectorXd& values) {
        VectorXd natural(m);
        for (int k = 0; k < m; ++k) natural[edges.problem_edge(k)] = values[k];
        return natural;
      };
      const VectorXd natural_mu = in_order_of_problem(mu);
      const auto dense = [&](const VectorXd& multipliers) {
        return dense_kkt(problem, mesh.x, multipliers);
      };
      const VectorXd eigenvalues = dense(natural_mu).selfadjointView<Eigen::Lower>().eigenvalues();
      const bool proper = (eigenvalues.array() < 0).count() == m;
      ++seen[proper];
      const bool certain = eigenvalues.cwiseAbs().minCoeff() > 1e-6;
      if (certain && (row.tells_inertia || (proper && !row.solves_all))) {
        EXPECT_EQ(kkt->convexified(), !proper);
      }
      if (row.chains) {
        EXPECT_EQ(work.factorizations, kkt->convexified() ? 2 : 1);  // none was left to UMFPACK
      }
      if (!proper && !row.solves_all) continue;
      const MatrixXd used =
          dense(kkt->convexified() ? VectorXd(natural_mu.cwiseMax(0)) : natural_mu);
      VectorXd solution(3 * n + m), rhs(3 * n + m);
      solution << p.reshaped(), in_order_of_problem(q);
      rhs << r.reshaped(), in_order_of_problem(c);
      EXPECT_LT((used * solution - rhs).norm(),
                row.accuracy * rhs.norm() + 1e-12 * used.norm() * solution.norm());
    }
  }
  EXPECT_GT(seen[true], 10) << "the multipliers are too large to test the usual case";
  EXPECT_GT(seen[false], 10) << "the multipliers are too small to test the other one";
}

TEST(ChainKkt, TakesNoOtherGraphs) {
  ProblemParts parts;
  parts.mass = {1, 1, 1, 1};
  parts.rest_length = {1, 1, 1};
  const struct {
    Edge last;
    std::vector<int> pinned;
    bool fits;
  } cases[] = {{{3, 2}, {}, true},
               {{3, 2}, {0, 3}, false},  // a chain between two pins
               {{3, 2}, {2}, true},
               {{1, 3}, {2}, false},   // not the next one
               {{2, 1}, {2}, false}};  // twice
  for (const auto& [last, pinned, fits] : cases) {
    parts.edges = {{0, 1}, {1, 2}, last};
    parts.pinned = pinned;
    const Problem problem(parts);
    EXPECT_EQ(forms_chains(problem), fits) << last.a << " " << last.b;
    if (!fits) {
      EXPECT_THROW(make_chain_kkt(problem, EdgeConstraints(problem, 0.01)), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace inextensible
