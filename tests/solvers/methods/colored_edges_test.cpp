// Colored edges over grids, chains, random graphs and stars: every edge once, no vertex twice in a
// color; sweeps over them against loops over the problem's own edges, written out.
#include "solvers/methods/colored_edges.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "solvers/methods/strain_passes.h"
#include "solvers/registry.h"
#include "solvers/systems/constraint_system.h"
#include "support/random_graph.h"

namespace inextensible {
namespace {

using Eigen::Vector3d;
using testing::Random;
using testing::RandomMesh;

// rows x columns, numbered row after row as the scenes do; unit masses and lengths.
Problem woven(int rows, int columns) {
  ProblemParts parts;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int v = i * columns + j;
      parts.mass.push_back(1);
      if (j + 1 < columns) parts.edges.push_back({v, v + 1});
      if (i + 1 < rows) parts.edges.push_back({v, v + columns});
    }
  }
  parts.rest_length.assign(parts.edges.size(), 1);
  return Problem(std::move(parts));
}

Problem star(int rays) {
  ProblemParts parts;
  parts.mass.assign(rays + 1, 1);
  for (int v = 1; v <= rays; ++v) parts.edges.push_back({0, v});
  parts.rest_length.assign(rays, 1);
  return Problem(std::move(parts));
}

// The same edge several times, as a misguided mesh may have it.
Problem doubled(int times) {
  ProblemParts parts;
  parts.mass.assign(40, 1);
  for (int v = 0; v + 1 < 40; ++v) parts.edges.insert(parts.edges.end(), times, {v, v + 1});
  parts.rest_length.assign(parts.edges.size(), 1);
  return Problem(std::move(parts));
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
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto size = [&](int most) { return 1 + static_cast<int>(random() % most); };
    const int rows = 1 + size(30), columns = 1 + size(30), pinned = size(3);
    const auto mesh = testing::random_mesh(random, rows, columns, pinned);
    expect_valid(*mesh.problem, ColoredEdges(*mesh.problem));
    const int n = 10 + size(200);
    const auto graph = testing::random_graph(random, n, size(2 * n), pinned, 0.1);
    expect_valid(*graph.problem, ColoredEdges(*graph.problem));
  }
  for (const int n : {1, 2, 15, 16, 17, 300}) expect_valid(star(n), ColoredEdges(star(n)));
  for (const int n : {1, 2, 3}) expect_valid(doubled(n), ColoredEdges(doubled(n)));
}

// What makes the sweeps fast: few fillers, and nothing to gather.
TEST(ColoredEdges, AreAdjacentOnClothAndChains) {
  for (const auto& [rows, columns, colors] : {std::tuple(31, 31, 4), std::tuple(30, 32, 4),
                                              std::tuple(71, 40, 4), std::tuple(1, 80, 2)}) {
    SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns));
    const Problem problem = woven(rows, columns);
    const ColoredEdges colored(problem);
    expect_valid(problem, colored);
    EXPECT_EQ(colored.blocks().back().color + 1, colors);
    for (const ColoredEdges::Block& block : colored.blocks()) EXPECT_TRUE(block.adjacent);
    EXPECT_LT(colored.entries(), 1.15 * problem.constraints() + 2 * ColoredEdges::width);
  }
}

TEST(ColoredEdges, BringPositionsThereAndBackBitForBit) {
  Random random(5);
  const auto mesh = testing::random_mesh(random, 9, 12, 3);
  const ColoredEdges colored(*mesh.problem);
  Positions x = mesh.x;
  x(1, 4) = -0.0;
  ColoredEdges::Places places = colored.make_places();
  colored.load(x, places);
  Positions back = Positions::Constant(3, x.cols(), 7);
  colored.store(places, back);
  for (int v = 0; v < x.cols(); ++v) {
    const bool pinned = mesh.problem->inverse_mass()[v] == 0;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(back(axis, v)),
                std::bit_cast<std::uint64_t>(pinned ? 7.0 : x(axis, v)));
    }
  }
}

struct Swept {
  Positions x;
  std::int64_t corrected = 0;
};

// The same sweep by the book: edges of `order` one by one, from `x` as it is now (in turn) or was
// at the beginning.
Swept by_the_book(const Problem& problem, const StrainBand& band,
                  const std::vector<double>& share_a, const std::vector<double>& share_b,
                  const std::vector<int>& order, const Positions& start, bool in_turn) {
  Swept swept{start};
  for (const int edge : order) {
    if (edge < 0) continue;
    const auto [a, b] = problem.edges()[edge];
    const Positions& from = in_turn ? swept.x : start;
    const Vector3d d = from.col(b) - from.col(a);
    const double stretch = d.norm() / problem.rest_length()[edge];
    if (stretch == 0 || (stretch * stretch >= band.low && stretch * stretch <= band.high)) continue;
    const double wanted = stretch < 1 ? band.target_low : band.target_high;
    const Vector3d correction = (1 - wanted / stretch) * d;
    swept.x.col(a) += share_a[edge] * correction;
    swept.x.col(b) -= share_b[edge] * correction;
    ++swept.corrected;
  }
  return swept;
}

void expect_sweeps_by_the_book(Random& random, const RandomMesh& mesh) {
  const Problem& problem = *mesh.problem;
  const StrainBand band(0.02, 0.3);
  std::vector<double> share_a, share_b;
  for (const Edge& e : problem.edges()) {
    const double wa = problem.inverse_mass()[e.a], wb = problem.inverse_mass()[e.b];
    share_a.push_back(0.6 * wa / (wa + wb));
    share_b.push_back(0.6 * wb / (wa + wb));
  }
  Positions start = testing::perturbed(random, mesh, 0.02);
  const Edge first = problem.edges().front();
  const bool pinned = problem.inverse_mass()[first.a] == 0;
  start.col(pinned ? first.b : first.a) = start.col(pinned ? first.a : first.b);  // no length
  StrainPasses sweep(problem, band, share_a, share_b);
  for (const bool in_turn : {true, false}) {
    const Swept expected =
        by_the_book(problem, band, share_a, share_b, sweep.edges().problem_edge(), start, in_turn);
    ASSERT_GT(expected.corrected, 0);
    Positions x = start;
    sweep.load(x);
    EXPECT_EQ(in_turn ? sweep.in_turn() : sweep.at_once(), expected.corrected);
    sweep.store(x);
    EXPECT_LT((x - expected.x).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(StrainPasses, EqualsALoopOverEdges) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    expect_sweeps_by_the_book(random, testing::random_mesh(random, 17, 24, 2));
    expect_sweeps_by_the_book(random, testing::random_graph(random, 150, 200, 2, 0.1));
  }
}

// A corrected edge then lies on the limit, where a rounding decides: it must not be corrected for
// ever.
TEST(StrainPasses, ConvergesWhereTheTargetIsTheLimit) {
  for (const char* solver : {"jacobi", "gauss_seidel", "gauss_seidel_colored"}) {
    for (const double limit : {0.01, 1e-6, 1e-10}) {
      SCOPED_TRACE(std::string(solver) + ", limit " + std::to_string(limit));
      ProblemParts parts;
      parts.mass = {1, 0.3};
      parts.edges = {{0, 1}};
      parts.rest_length = {0.7};
      const auto problem = std::make_shared<const Problem>(parts);
      for (const double length : {0.2, 0.69, 0.71, 3.0}) {
        State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
        state.x.col(1) = length * Vector3d(0.3, -0.5, 0.2).normalized();
        Settings settings{{"target", 1.0}, {"max_iterations", 2000.0}};
        EXPECT_TRUE(make_stepper(solver, problem, {limit, 1, settings})->advance(state, 0.01));
      }
    }
  }
}

}  // namespace
}  // namespace inextensible
