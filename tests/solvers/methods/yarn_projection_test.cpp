// Yarns are found whatever the mesh; a yarn's projection is fast projection's on a chain.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "solvers/methods/yarn_pass.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::h;

void check(const Problem& problem, const std::vector<Yarn>& yarns) {
  std::multiset<int> edges;
  std::map<int, std::set<int>> vertices_of_color;
  for (const Yarn& yarn : yarns) {
    ASSERT_EQ(yarn.vertices.size(), yarn.edges.size() + 1);
    for (std::size_t i = 0; i < yarn.edges.size(); ++i) {
      const Edge e = problem.edges()[yarn.edges[i]];
      const std::set<int> ends{e.a, e.b}, here{yarn.vertices[i], yarn.vertices[i + 1]};
      ASSERT_EQ(ends, here);
      edges.insert(yarn.edges[i]);
    }
    for (const int vertex : yarn.vertices)
      ASSERT_TRUE(vertices_of_color[yarn.color].insert(vertex).second) << "color " << yarn.color;
  }
  ASSERT_EQ(edges.size(), static_cast<std::size_t>(problem.constraints()));
  ASSERT_EQ(std::set<int>(edges.begin(), edges.end()).size(), edges.size()) << "an edge twice";
}

TEST(Yarns, OfWovenClothAreItsRowsAndColumns) {
  testing::Random random(1);
  for (const auto& [rows, columns] :
       {std::pair(5, 7), std::pair(2, 9), std::pair(12, 3), std::pair(1, 30)}) {
    const auto mesh = testing::random_mesh(random, rows, columns, 1);
    const auto yarns = yarns_of(*mesh.problem);
    check(*mesh.problem, yarns);
    EXPECT_EQ(std::ssize(yarns), rows == 1 ? 1 : rows + columns);
    std::set<int> colors;
    for (const Yarn& yarn : yarns) colors.insert(yarn.color);
    EXPECT_EQ(colors, (rows == 1 ? std::set{0} : std::set{0, 1})) << "warp and weft";
  }
}

// Also on several chains: yarns side by side in the lanes of a vector, of unequal lengths, do not
// feel each other.
TEST(YarnProjection, OnChainsIsFastProjectionOnEach) {
  testing::for_seeds(40, [](testing::Random& random, std::uint64_t seed) {
    std::vector<testing::RandomMesh> chains;
    ProblemParts parts;
    parts.gravity.setZero();
    const int count = seed % 2 ? 1 : 2 + static_cast<int>(random() % 20);
    for (int i = 0; i < count; ++i) {
      chains.push_back(testing::random_mesh(random, 1, 2 + static_cast<int>(random() % 40), 1));
      const Problem& chain = *chains.back().problem;
      const int first = static_cast<int>(parts.mass.size());
      parts.mass.insert(parts.mass.end(), chain.mass().begin(), chain.mass().end());
      for (const int vertex : chain.pinned()) parts.pinned.push_back(first + vertex);
      for (const Edge e : chain.edges()) parts.edges.push_back({first + e.a, first + e.b});
      parts.rest_length.insert(parts.rest_length.end(), chain.rest_length().begin(),
                               chain.rest_length().end());
    }
    const Problem all(parts);
    const auto yarns = make_velocity_filter("yarn_projection", all, {1e-3, 1, {{"target", 0.0}}});
    int iterations = 0;  // of the chain that takes most
    Positions x(3, all.vertices()), wanted = x, start = x;
    WorkCounters work;
    for (Eigen::Index at = 0; const testing::RandomMesh& chain : chains) {
      const Eigen::Index n = chain.x.cols();
      Positions y = testing::perturbed(random, chain, 0.05);
      x.middleCols(at, n) = y;
      start.middleCols(at, n) = chain.x;
      const auto projection = make_velocity_filter("fast_projection", *chain.problem, {1e-3});
      const StepResult result = projection->apply(chain.x, h, y, work);
      ASSERT_TRUE(result) << result.detail;
      iterations = std::max(iterations, result.iterations);
      wanted.middleCols(at, n) = y;
      at += n;
    }
    const StepResult result = yarns->apply(start, h, x, work);
    ASSERT_TRUE(result) << result.detail;
    EXPECT_EQ(result.iterations, iterations);
    EXPECT_LE((x - wanted).cwiseAbs().maxCoeff(), 1e-10);
  });
}

// What yarns need many rounds for, cloth stretched as a whole, the projection of the whole does in
// a few; where yarns are quick nothing is factored.
TEST(FastProjectionAdaptive, ProjectsTheWholeWhereYarnsAreSlowAndNotWhereTheyAreQuick) {
  testing::for_seeds(5, [](testing::Random& random, std::uint64_t) {
    const auto cloth = testing::random_mesh(random, 50, 50, 1);
    const int pin = cloth.problem->pinned().front();
    for (const double limit : {0.1, 1e-5}) {
      const auto yarns = make_velocity_filter("yarn_projection", *cloth.problem, {limit});
      const auto adaptive =
          make_velocity_filter("fast_projection_adaptive", *cloth.problem, {limit});
      const EdgeConstraints edges(*cloth.problem, limit);
      WorkCounters work, yarns_work;
      int rounds = 0, yarns_rounds = 0;
      for (int step = 0; step < 5; ++step) {
        Positions x = testing::perturbed(random, cloth, limit < 1e-3 ? 1e-6 : 0.005);
        if (limit < 1e-3) x = (1.03 * (x.colwise() - x.col(pin))).colwise() + x.col(pin).eval();
        Positions y = x;
        const StepResult mine = adaptive->apply(cloth.x, h, x, work);
        const StepResult theirs = yarns->apply(cloth.x, h, y, yarns_work);
        ASSERT_TRUE(mine && theirs) << mine.detail;
        EXPECT_TRUE(edges.permissible(x));
        rounds += mine.iterations;
        yarns_rounds += theirs.iterations;
      }
      if (limit < 1e-3) {
        EXPECT_LT(2 * rounds, yarns_rounds);
        EXPECT_GT(work.factor_flops, 0);
      } else {
        EXPECT_EQ(work.factor_flops, 0);
      }
    }
  });
}

}  // namespace
}  // namespace inextensible
