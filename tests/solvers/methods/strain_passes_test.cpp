// Colored edges over grids, chains, random graphs and stars: every edge once, no vertex twice in a
// color; passes over them against loops over the problem's own edges, written out; and the strain
// limiters that make such passes.
#include "solvers/methods/strain_passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "solvers/registry.h"
#include "support/motion.h"
#include "support/random_graph.h"

namespace inextensible {
namespace {

using Eigen::Vector3d;
using testing::for_seeds;
using testing::h;
using testing::Random;
using testing::RandomMesh;

Problem with_unit_edges(int vertices, std::vector<Edge> edges) {
  ProblemParts parts;
  parts.mass.assign(vertices, 1);
  parts.rest_length.assign(edges.size(), 1);
  parts.edges = std::move(edges);
  return Problem(std::move(parts));
}

Problem star(int rays) {
  std::vector<Edge> edges;
  for (int v = 1; v <= rays; ++v) edges.push_back({0, v});
  return with_unit_edges(rays + 1, std::move(edges));
}

// The same edge several times, as a misguided mesh may have it.
Problem doubled(int times) {
  std::vector<Edge> edges;
  for (int v = 0; v + 1 < 40; ++v) edges.insert(edges.end(), times, {v, v + 1});
  return with_unit_edges(40, std::move(edges));
}

void expect_valid(const Problem& problem, const ColoredEdges& colored) {
  std::vector<int> seen(problem.constraints(), 0);
  std::map<int, std::set<int>> vertices_of_color;
  int next = 0;
  for (const ColoredEdges::Block& block : colored.blocks()) {
    ASSERT_EQ(block.first, next);
    ASSERT_EQ(block.count % ColoredEdges::width, 0);
    next += block.count;
    std::set<int> of_edges, of_fillers;  // places in this block
    for (int k = block.first; k < next; ++k) {
      const int a = colored.a()[k], b = colored.b()[k];
      if (block.adjacent) {
        ASSERT_EQ(a, colored.a()[block.first] + k - block.first);
        ASSERT_EQ(b, colored.b()[block.first] + k - block.first);
      }
      const int edge = colored.problem_edge()[k];
      auto& places = edge < 0 ? of_fillers : of_edges;
      const bool a_is_new = places.insert(a).second, b_is_new = places.insert(b).second;
      EXPECT_TRUE((a_is_new && b_is_new) || (edge < 0 && !block.adjacent)) << "place twice";
      if (edge < 0) continue;
      ++seen[edge];
      Edge e = problem.edges()[edge];
      if (colored.turned(k)) std::swap(e.a, e.b);
      EXPECT_EQ(colored.vertex(a), e.a);
      EXPECT_EQ(colored.vertex(b), e.b);
      auto& vertices = vertices_of_color[block.color];
      EXPECT_TRUE(vertices.insert(e.a).second && vertices.insert(e.b).second)
          << "edge " << edge << " shares a vertex with another of color " << block.color;
    }
    for (const int place : of_fillers) EXPECT_FALSE(of_edges.contains(place));
  }
  EXPECT_EQ(next, colored.entries());
  for (const int times : seen) EXPECT_EQ(times, 1);
}

TEST(ColoredEdges, HoldEveryEdgeOnceAndNoVertexTwiceInAColor) {
  for_seeds(40, [](Random& random, std::uint64_t) {
    const auto size = [&](int most) { return 1 + static_cast<int>(random() % most); };
    const int rows = 1 + size(30), columns = 1 + size(30), pinned = size(3);
    const auto mesh = testing::random_mesh(random, rows, columns, pinned);
    expect_valid(*mesh.problem, ColoredEdges(*mesh.problem));
    const int n = 10 + size(200);
    const auto graph = testing::random_graph(random, n, size(2 * n), pinned, 0.1);
    expect_valid(*graph.problem, ColoredEdges(*graph.problem));
  });
  for (const int n : {1, 2, 15, 16, 17, 300}) expect_valid(star(n), ColoredEdges(star(n)));
  for (const int n : {1, 2, 3}) expect_valid(doubled(n), ColoredEdges(doubled(n)));
}

// What makes the passes fast on woven cloth, numbered row after row as the scenes do: few fillers,
// and nothing to gather.
TEST(ColoredEdges, AreAdjacentOnClothAndChains) {
  Random random(1);
  for (const auto& [rows, columns, colors] : {std::tuple(31, 31, 4), std::tuple(30, 32, 4),
                                              std::tuple(71, 40, 4), std::tuple(1, 80, 2)}) {
    SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns));
    const auto mesh = testing::random_mesh(random, rows, columns, 0);
    const ColoredEdges colored(*mesh.problem);
    expect_valid(*mesh.problem, colored);
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
    if (edge < 0) continue;
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
  for (const bool in_turn : {true, false}) {
    Positions x = start, expected = start;
    const int corrected =
        pass_by_the_book(problem, band, 0.6, passes.edges().problem_edge(), in_turn, expected);
    ASSERT_GT(corrected, 0);
    passes.load(x);
    EXPECT_EQ(in_turn ? passes.in_turn() : passes.at_once(), corrected);
    passes.store(x);
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(StrainPasses, EqualALoopOverEdges) {
  for_seeds(20, [](Random& random, std::uint64_t) {
    expect_passes_by_the_book(random, testing::random_mesh(random, 17, 24, 2));
    expect_passes_by_the_book(random, testing::random_graph(random, 150, 200, 2, 0.1));
  });
}

// A corrected edge then lies on the limit, where a rounding decides: it must not be corrected for
// ever.
TEST(StrainLimiting, ConvergesWhereTheTargetIsTheLimit) {
  const auto problem = testing::one_edge(1, 0.3);
  for (const char* solver : {"jacobi", "gauss_seidel", "gauss_seidel_colored"}) {
    for (const double limit : {0.01, 1e-6, 1e-10}) {
      for (const double length : {0.3, 0.98, 1.02, 4.0}) {
        SCOPED_TRACE(std::string(solver) + ", limit " + std::to_string(limit));
        State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
        state.x.col(1) = length * Vector3d(0.3, -0.5, 0.2).normalized();
        const Settings settings{{"target", 1.0}, {"max_iterations", 2000.0}};
        EXPECT_TRUE(make_stepper(solver, problem, {limit, 1, settings})->advance(state, h));
      }
    }
  }
}

// An edge 30 % too long at a limit of 10 %, one correction after the other: with relaxation 1.5 its
// strain is 0.3, -0.15, 0.075; with 0.5 it is 0.3, 0.15, 0.075. The heavier end moves less.
TEST(StrainLimiting, TakesItsRelaxationTimesTheCorrection) {
  for (const char* solver : {"gauss_seidel", "gauss_seidel_colored", "jacobi"}) {
    for (const double relaxation : {0.5, 1.5}) {
      SCOPED_TRACE(std::string(solver) + ", relaxation " + std::to_string(relaxation));
      const auto stepper =
          make_stepper(solver, testing::one_edge(1, 3), {0.1, 1, {{"relaxation", relaxation}}});
      State state = testing::stretched_edge(1.3);
      const StepResult result = stepper->advance(state, h);
      ASSERT_TRUE(result);
      EXPECT_EQ(result.iterations, 2);
      EXPECT_NEAR((state.x.col(1) - state.x.col(0)).norm(), 1.075, 1e-14);
      EXPECT_NEAR(state.x(0, 0), 0.75 * 0.225, 1e-14);
    }
  }
}

TEST(Jacobi, ConvergesAtValenceThirtyWithUnequalMasses) {
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass.push_back(1e-3);
  State state{Positions::Zero(3, 31), Positions::Zero(3, 31), 0};
  for (int i = 1; i <= 30; ++i) {
    parts.mass.push_back(i % 2 ? 1.0 : 1e-3);
    parts.edges.push_back({0, i});
    parts.rest_length.push_back(1);
    state.x.col(i) << std::cos(0.2 * i), std::sin(0.2 * i), 0.01 * i;
  }
  state.x *= 1.3;  // every edge 30 % too long
  const auto problem = std::make_shared<const Problem>(std::move(parts));
  EXPECT_TRUE(make_stepper("jacobi", problem, {1e-3})->advance(state, h));
}

}  // namespace
}  // namespace inextensible
