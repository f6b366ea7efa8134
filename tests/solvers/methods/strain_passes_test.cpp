// Passes over colored edges against loops over the problem's own edges; and the strain limiters.
#include "solvers/methods/strain_passes.h"

#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using Eigen::Vector3d, testing::for_seeds, testing::h, testing::Random, testing::RandomMesh,
    testing::single_rounding;

// What makes passes fast on cloth numbered row after row: few fillers, and nothing to gather.
TEST(ColoredEdges, AreAdjacentOnClothAndChains) {
  Random random(1);
  for (const auto& [rows, columns, colors] : {std::tuple(31, 31, 4), std::tuple(30, 32, 4),
                                              std::tuple(71, 40, 4), std::tuple(1, 80, 2)}) {
    SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns));
    const auto mesh = testing::random_mesh(random, rows, columns, 0);
    const ColoredEdges colored(*mesh.problem);
    EXPECT_EQ(colored.blocks().back().color + 1, colors);
    for (const ColoredEdges::Block& block : colored.blocks()) EXPECT_TRUE(block.adjacent);
    EXPECT_LT(colored.entries(), 1.15 * mesh.problem->constraints() + 2 * ColoredEdges::width);
  }
}

// The same pass by the book: edges of `order` one by one, from `x` as it is now (in turn) or was at
// the beginning. Returns how many were corrected.
int pass_by_the_book(const Problem& problem, const StrainBand& band, double relaxation,
                     const std::vector<int>& order, bool in_turn, Positions& x) {
  const Positions start = x;
  int corrected = 0;
  for (const int edge : order) {
    const auto [a, b] = problem.edges()[edge];
    const Positions& from = in_turn ? x : start;
    const Vector3d d = from.col(b) - from.col(a);
    const double stretch = d.norm() / problem.rest_length()[edge];
    if (stretch == 0 || (stretch * stretch >= band.low && stretch * stretch <= band.high)) continue;
    const double wanted = stretch < 1 ? band.target_low : band.target_high;
    const double wa = problem.inverse_mass()[a], wb = problem.inverse_mass()[b];
    const Vector3d correction = relaxation * (1 - wanted / stretch) / (wa + wb) * d;
    x.col(a) += wa * correction;
    x.col(b) -= wb * correction;
    ++corrected;
  }
  return corrected;
}

void expect_passes_by_the_book(Random& random, const RandomMesh& mesh) {
  const Problem& problem = *mesh.problem;
  const StrainBand band(0.02, 0.3);
  Positions start = testing::perturbed(random, mesh, 0.02);
  const Edge first = problem.edges().front();
  const bool pinned = problem.inverse_mass()[first.a] == 0;
  start.col(pinned ? first.b : first.a) = start.col(pinned ? first.a : first.b);  // no length
  StrainPasses passes = StrainPasses::by_mass(problem, band, 0.6);
  std::vector<int> order = passes.edges().problem_edge(), all(problem.constraints());
  std::erase_if(order, [](int edge) { return edge < 0; });  // fillers
  std::iota(all.begin(), all.end(), 0);
  ASSERT_TRUE(std::ranges::is_permutation(order, all));
  for (const StrainPasses::Order pass :
       {StrainPasses::Order::in_turn, StrainPasses::Order::at_once}) {
    const bool in_turn = pass == StrainPasses::Order::in_turn;
    Positions x = start, expected = start;
    const int corrected = pass_by_the_book(problem, band, 0.6, order, in_turn, expected);
    ASSERT_GT(corrected, 0);
    passes.load(x);
    EXPECT_EQ(passes.pass(pass), corrected);
    passes.store(x);
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), single_rounding);
  }
}

RandomMesh star(Random& random, int rays) {
  Positions x = Positions::Zero(3, rays + 1);
  std::vector<Edge> edges;
  for (int v = 1; v <= rays; ++v) {
    x.col(v) = testing::random_vector(random, 1).normalized();
    edges.push_back({0, v});
  }
  const std::vector<double> mass(x.cols(), 1);
  return {std::make_shared<const Problem>(testing::parts_at_rest(x, edges, mass)), x};
}

// Also where edges share all their vertices, or have two and the same.
TEST(StrainPasses, EqualALoopOverEdges) {
  for_seeds(20, [](Random& random, std::uint64_t) {
    const auto size = [&](int most) { return 2 + static_cast<int>(random() % most); };
    expect_passes_by_the_book(random, testing::random_mesh(random, 17, 24, 2));
    expect_passes_by_the_book(random, testing::random_mesh(random, size(30), size(30), size(2)));
    expect_passes_by_the_book(random, testing::random_graph(random, 150, 200, 2, 0.1));
    expect_passes_by_the_book(random, testing::random_chains(random, 20, 0.1, true));
  });
  Random random(1);
  for (const int rays : {2, 15, 16, 17, 64}) expect_passes_by_the_book(random, star(random, rays));
}

// A corrected edge lies on the limit, where roundings decide: it must not be corrected for ever.
TEST(StrainLimiting, ConvergesWhereTheTargetIsTheLimit) {
  const auto problem = testing::one_edge(1, 0.3);
  for (const char* solver : {"jacobi", "gauss_seidel", "gauss_seidel_colored"})
    for (const double limit : {0.01, 1e-6, 1e-10})
      for (const double length : {0.3, 0.98, 1.02, 4.0}) {
        SCOPED_TRACE(std::string(solver) + ", limit " + std::to_string(limit));
        State state = testing::stretched_edge(0);
        state.x.col(1) = length * Vector3d(0.3, -0.5, 0.2).normalized();
        const Settings settings{{"target", 1.0}, {"max_iterations", 2000.0}};
        EXPECT_TRUE(make_stepper(solver, problem, {limit, 1, settings})->advance(state, h));
      }
}

// An edge 30 % too long at a limit of 10 %, one correction after the other: with relaxation 1.5 its
// strain is 0.3, -0.15, 0.075; with 0.5 it is 0.3, 0.15, 0.075. The heavier end moves less.
TEST(StrainLimiting, TakesItsRelaxationTimesTheCorrection) {
  for (const char* solver : {"gauss_seidel", "gauss_seidel_colored", "jacobi"})
    for (const double relaxation : {0.5, 1.5}) {
      SCOPED_TRACE(std::string(solver) + ", relaxation " + std::to_string(relaxation));
      const auto stepper =
          make_stepper(solver, testing::one_edge(1, 3), {0.1, 1, {{"relaxation", relaxation}}});
      State state = testing::stretched_edge(1.3);
      const StepResult result = stepper->advance(state, h);
      ASSERT_TRUE(result);
      EXPECT_EQ(result.iterations, 2);
      EXPECT_NEAR((state.x.col(1) - state.x.col(0)).norm(), 1.075, single_rounding);
      EXPECT_NEAR(state.x(0, 0), 0.75 * 0.225, single_rounding);
    }
}

TEST(Jacobi, ConvergesAtValenceThirtyWithUnequalMasses) {
  Random random(1);
  const RandomMesh mesh = star(random, 30);
  ProblemParts parts = testing::parts_of(*mesh.problem);
  for (int i = 0; i <= 30; i += 2) parts.mass[i] = 1e-3;
  State state{1.3 * mesh.x, 0 * mesh.x, 0};  // every edge 30 % too long
  const auto problem = std::make_shared<const Problem>(std::move(parts));
  EXPECT_TRUE(make_stepper("jacobi", problem, {1e-3})->advance(state, h));
}

}  // namespace
}  // namespace inextensible
