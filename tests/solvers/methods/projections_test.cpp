// Fast projection and ICD: the theorems of the paper. Yarns are found whatever the mesh; a yarn's
// projection is fast projection's on a chain. Where methods fail is asked by the hard cases.
#include <Eigen/Dense>

#include "solvers/methods/yarn_pass.h"
#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::for_seeds, testing::h, testing::Random, testing::random_mesh, testing::RandomMesh;
constexpr int meshes = 8;

struct Filtered {
  Filtered(const char* name, const RandomMesh& mesh, const Positions& candidate,
           const BackendOptions& options)
      : x(candidate),
        result(make_velocity_filter(name, *mesh.problem, options)->apply(mesh.x, h, x, work)) {
    EXPECT_TRUE(result) << name << ": " << result.detail;
  }
  Positions x;
  WorkCounters work;
  StepResult result;
};

// Section 4.3: "The first iteration of these methods is identical."
TEST(FastProjection, FirstIterationIsIcdsFirstNewtonIteration) {
  for_seeds(meshes, [](Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 4, 5, 2);
    const Problem& p = *mesh.problem;
    const Positions candidate = testing::perturbed(random, mesh, 0.02);
    // In reach of one iteration: candidates are off by some 0.03, the first iterate by its square.
    const double limit = 0.004;
    ASSERT_FALSE(EdgeConstraints(p, limit).permissible(candidate));
    const Filtered fast("fast_projection", mesh, candidate,
                        {limit, 1, {{"linear_solver", std::string("multifrontal")}}});
    // ICD stops as soon as the strain is permissible, as fast projection does.
    const Filtered icd("icd", mesh, candidate, {limit, 1, {{"direction_tolerance", 1e3}}});
    ASSERT_EQ(fast.result.iterations, 1);
    ASSERT_EQ(icd.result.iterations, 1);
    EXPECT_LT((fast.x - icd.x).norm(), 1e-9 * (fast.x - candidate).norm());
    // And both are x0 - W J^T (J W J^T)^-1 C, densely.
    const Eigen::MatrixXd j = testing::dense_gradient(p, candidate),
                          wjt = testing::dense_moves(p, candidate);
    const Eigen::VectorXd c =  // |d|^2 / l - l, of which j d is twice the first part
        0.5 * j * candidate.reshaped() -
        Eigen::VectorXd::Map(p.rest_length().data(), p.constraints());
    const Eigen::VectorXd dx = -wjt * (j * wjt).ldlt().solve(c);
    EXPECT_LT(((fast.x - candidate).reshaped() - dx).norm(), 1e-10);
  });
}

// Theorem 1 and section 4.3, to first order: a candidate that is off the manifold by e is taken to
// within O(e^2) of the closest point, which ICD finds. Corrections of single edges along themselves
// keep to the span of W J^T, so that sweeps between projections change nothing about that order
// (Kaczmarz 1937: from x0 they end at the closest point of linear constraints). What is off by a
// part of its correction, however small, halves with e; this quarters.
TEST(FastProjection, PlainOrSmoothedIsTheClosestPointToFirstOrder) {
  constexpr double limit = 1e-9;  // C = 0 for all that matters here
  for (const double sweeps : {0.0, 30.0}) {
    SCOPED_TRACE("sweeps " + std::to_string(sweeps));
    double off[2] = {0, 0};
    for_seeds(meshes, [&](Random& random, std::uint64_t) {
      const auto mesh = random_mesh(random, 8, 8, 2);
      const Positions displacement = testing::perturbed(random, mesh, 1) - mesh.x;
      for (const int halved : {0, 1}) {
        const Positions candidate = mesh.x + (halved ? 0.005 : 0.01) * displacement;
        const Filtered fast("fast_projection", mesh, candidate,
                            {limit, 1, {{"smoothing_sweeps", sweeps}}}),
            closest("icd", mesh, candidate, {limit});
        EXPECT_EQ(fast.work.edge_projections > 0, sweeps > 0);
        off[halved] += (fast.x - closest.x).norm();
      }
    });
    EXPECT_LT(off[1], 0.3 * off[0]);  // 1/4, and 1/2 for what is of first order
    EXPECT_GT(off[1], 1e3 * limit);   // what is measured is not the limit's slack
  }
}

// Sweeps replace projections: some of them after each, all if as many as it takes come before.
TEST(FastProjection, SweepsReplaceProjections) {
  int projections[3] = {0, 0, 0};
  for_seeds(meshes, [&](Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 12, 12, 2);
    const Positions candidate = testing::perturbed(random, mesh, 0.2);
    const Settings ways[] = {{}, {{"smoothing_sweeps", 30.0}}, {{"sweeps_before", 1e5}}};
    for (std::size_t i = 0; i < 3; ++i) {
      const Filtered fast("fast_projection", mesh, candidate, {0.01, 1, ways[i]});
      projections[i] += fast.result.iterations;
      EXPECT_TRUE(EdgeConstraints(*mesh.problem, 0.01).permissible(fast.x));
    }
  });
  EXPECT_LT(projections[1], 0.8 * projections[0]);
  EXPECT_EQ(projections[2], 0);
}

// Theorem 1: ICD's solution extremizes the M-norm distance to the candidate over {C = 0}: no motion
// of free vertices in the null space of J changes it. Dense Newton finds the same point.
TEST(Icd, SolutionIsTheClosestPointOfTheManifold) {
  for_seeds(meshes, [](Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 3, 4, 1);
    const Problem& p = *mesh.problem;
    const Positions candidate = testing::perturbed(random, mesh, 0.05);
    const Filtered icd("icd", mesh, candidate, {1e-10}),
        oracle("dense_newton", mesh, candidate, {});
    EXPECT_LT((icd.x - oracle.x).norm(), 1e-7);
    const auto mass = Eigen::RowVectorXd::Map(p.mass().data(), p.vertices());
    const Positions gradient = (icd.x - candidate).array().rowwise() * mass.array();
    EXPECT_GT(gradient.norm(), 1e-3);
    const Eigen::MatrixXd j = testing::dense_gradient(p, icd.x);
    Eigen::MatrixXd motions = Eigen::MatrixXd::Identity(j.cols(), j.cols());
    for (const int v : p.pinned()) motions.middleCols(3 * v, 3).setZero();
    motions = motions * (j * motions).fullPivLu().kernel();
    EXPECT_LT((motions.transpose() * gradient.reshaped()).norm(), 1e-8 * motions.norm());
  });
}

// An edge far beyond the limit, iterated to the end: what is left of C is `target` of what is
// permissible. One within the target stays where it is.
TEST(ProjectionMethods, BringEdgesToTheirTarget) {
  const auto problem = testing::one_edge(1, 3);
  const double target = 0.5;
  for (const char* solver : {"fast_projection", "shake", "icd"}) {
    SCOPED_TRACE(solver);
    const auto length_from = [&](double length, double iterations) {
      const auto stepper = make_stepper(
          solver, problem, {0.1, 1, {{"target", target}, {"min_iterations", iterations}}});
      State state = testing::stretched_edge(length);
      EXPECT_TRUE(stepper->advance(state, h));
      return (state.x.col(1) - state.x.col(0)).norm();
    };
    EXPECT_NEAR(length_from(1.3, 40), std::sqrt(1 + target * (1.1 * 1.1 - 1)), 1e-12);
    // C is convex: from below Newton's first step leads beyond the target, and is the last one.
    const double wanted = 1 + target * (0.9 * 0.9 - 1);  // length squared
    EXPECT_NEAR(length_from(0.8, 40), (0.8 * 0.8 + wanted) / (2 * 0.8), 1e-8);
    EXPECT_EQ(length_from(1.05, solver == std::string_view("icd") ? 0 : 1), 1.05);
  }
}

TEST(Yarns, OfWovenClothAreItsRowsAndColumns) {
  testing::Random random(1);
  for (const auto& [rows, columns] :
       {std::pair(5, 7), std::pair(2, 9), std::pair(12, 3), std::pair(1, 30)}) {
    const auto mesh = random_mesh(random, rows, columns, 1);
    std::map<int, std::set<int>> vertices_of_color;
    std::set<int> seen;
    const auto yarns = yarns_of(*mesh.problem);
    EXPECT_EQ(std::ssize(yarns), rows == 1 ? 1 : rows + columns);
    for (const Yarn& yarn : yarns) {
      ASSERT_EQ(yarn.vertices.size(), yarn.edges.size() + 1);
      for (std::size_t i = 0; i < yarn.edges.size(); ++i) {
        const auto [a, b] = mesh.problem->edges()[yarn.edges[i]];
        EXPECT_EQ(std::minmax(a, b), std::minmax(yarn.vertices[i], yarn.vertices[i + 1]));
        EXPECT_TRUE(seen.insert(yarn.edges[i]).second) << "an edge twice";
      }
      for (const int vertex : yarn.vertices)
        EXPECT_TRUE(vertices_of_color[yarn.color].insert(vertex).second) << "color " << yarn.color;
    }
    EXPECT_EQ(std::ssize(seen), mesh.problem->constraints());
    EXPECT_EQ(std::ssize(vertices_of_color), rows == 1 ? 1 : 2) << "warp and weft";
  }
}

// Also on several: yarns of unequal lengths, side by side in a vector, do not feel each other.
TEST(YarnProjection, OnChainsIsFastProjectionOnEach) {
  for_seeds(40, [](Random& random, std::uint64_t seed) {
    std::vector<RandomMesh> chains;
    ProblemParts parts;
    parts.gravity.setZero();
    const int count = seed % 2 ? 1 : 2 + static_cast<int>(random() % 20);
    for (int i = 0; i < count; ++i) {
      chains.push_back(random_mesh(random, 1, 2 + static_cast<int>(random() % 40), 1));
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
    for (Eigen::Index at = 0; const RandomMesh& chain : chains) {
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
  for_seeds(5, [](Random& random, std::uint64_t) {
    const auto cloth = random_mesh(random, 50, 50, 1);
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
