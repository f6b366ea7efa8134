// Springs, PBD with substeps and soft step: what makes them cheap, and what they converge to.
#include <Eigen/Dense>
#include <numbers>

#include "solvers/methods/vertex_passes.h"
#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::for_seeds, testing::h, testing::moving_state, testing::Random, testing::random_mesh,
    testing::RandomMesh;

std::unique_ptr<Stepper> springs(const RandomMesh& mesh, Settings settings) {
  settings["stiffness"] = 1e5;
  return make_stepper("implicit_springs", mesh.problem, {0.01, 1, settings});
}

// However long a factorization is kept, each step ends within the tolerance of where Newton with a
// fresh one, iterated until rounding, ends. Also where the history is of another motion. Vertices
// move gently enough that the energy has one minimum nearby: springs buckle neither way.
TEST(ImplicitSprings, EndEveryStepAtTheMinimumWhateverTheyReuse) {
  for (const double reuse : {0.0, 10.0, 100.0}) {
    SCOPED_TRACE("reuse " + std::to_string(reuse));
    for_seeds(16, [&](Random& random, std::uint64_t) {
      const RandomMesh mesh = random_mesh(random, 4, 4, 2);
      const auto exact = springs(mesh, {{"reuse", 0.0}, {"newton_tolerance", 1e-7}}),
                 other = springs(mesh, {{"reuse", reuse}, {"newton_tolerance", 0.1}});
      State elsewhere = moving_state(random, mesh, 0.5), state = moving_state(random, mesh, 0.5);
      ASSERT_TRUE(other->advance(elsewhere, 2 * h));
      for (int step = 0; step < 20; ++step) {
        State copy = state;
        ASSERT_TRUE(exact->advance(state, h));
        ASSERT_TRUE(other->advance(copy, h));
        EXPECT_LE((copy.x - state.x).colwise().norm().maxCoeff(),
                  0.1 * 0.01 * mesh.problem->shortest_rest_length())
            << "step " << step;
      }
    });
  }
}

// The step of Chen et al. 2024 for one vertex: x += H^-1 f.
void move(int v, const Problem& problem, const Springs& springs, const Positions& y, Positions& x) {
  const double m = problem.mass()[v];
  Eigen::Vector3d f = m * (y.col(v) - x.col(v));
  Eigen::Matrix3d hessian = m * Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < springs.edges.size(); ++k) {
    const auto [a, b] = springs.edges[k];
    if (a != v && b != v) continue;
    const Eigen::Vector3d d = x.col(a == v ? b : a) - x.col(v), n = d.normalized();
    const double stiffness = springs.stiffness[k], rest = springs.rest_length[k];
    f += stiffness * (d.norm() - rest) * n;
    const Eigen::Matrix3d along = n * n.transpose();
    hessian += stiffness *
               (along + std::max(0.0, 1 - rest / d.norm()) * (Eigen::Matrix3d::Identity() - along));
  }
  x.col(v) += hessian.llt().solve(f);
}

// The even vertices of a row come first, then the odd ones; colors start again behind a pin.
TEST(VertexPasses, MoveOneVertexAfterTheOtherInColors) {
  for_seeds(8, [](Random& random, std::uint64_t seed) {
    const int n = 2 + static_cast<int>(random() % 40);
    const RandomMesh row = random_mesh(random, 1, n, static_cast<int>(seed % 2));
    const Problem& problem = *row.problem;
    const int pin = problem.pinned().empty() ? n : problem.pinned()[0];
    Springs springs{problem.edges(), problem.rest_length(), {}};
    for (int k = 0; k < problem.constraints(); ++k)
      springs.stiffness.push_back(testing::uniform(random, 0, 100));
    const Positions y = testing::perturbed(random, row, 0.2);
    Positions x = testing::perturbed(random, row, 0.2), wanted = x;
    VertexPasses passes(problem, springs);
    passes.load(x, y, problem.mass());
    for (int i = 0; i < 3; ++i) {
      passes.visit_all(1);
      for (const int color : {0, 1})
        for (int v = 0; v < n; ++v) {
          const int place = v < pin ? v : v - pin - 1;
          if (v != pin && place % 2 == color) move(v, problem, springs, y, wanted);
        }
    }
    passes.store(x);
    EXPECT_LT((x - wanted).cwiseAbs().maxCoeff(), 1e-12);
  });
}

// The first step starts from the free flight, later ones from as much of gravity as the last step
// let through: a rope at rest from where it is, so that one pass leaves it there.
TEST(VertexBlockDescent, StartsWhereTheLastStepSaysThatItWillEnd) {
  constexpr int links = 10;
  constexpr double stiffness = 1e4, mass = 0.1, length = 0.1;
  const testing::HangingRope rope(links, length, mass);
  State rest = rope.start;
  for (int i = 0; i < links; ++i)  // each link bears what hangs on it
    rest.x(1, i + 1) = rest.x(1, i) - length * (1 + (links - i) * mass * rope.gravity / stiffness);
  for (const double iterations : {1.0, 5.0}) {
    const auto stepper =
        make_stepper("vertex_block_descent", rope.problem,
                     {0.01, 1, {{"stiffness", stiffness}, {"iterations", iterations}}});
    State state = rest;
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_GT((state.x - rest.x).cwiseAbs().maxCoeff(), 1e-6);
    state = {rest.x, rest.v, h};  // at rest, a step later
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_LT((state.x - rest.x).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// ---- Methods whose strain the time step controls: the strain that theory gives a loaded rope ----

constexpr int rope_links = 10;
constexpr double link_length = 0.1, vertex_mass = 0.1;

// By how much each link is longer than at rest after 20 s of hanging.
std::vector<double> elongations(const char* solver, double step, const Settings& settings) {
  const testing::HangingRope rope(rope_links, link_length, vertex_mass);
  const auto stepper = make_stepper(solver, rope.problem, {0.01, 1, settings});
  State state = rope.start;
  while (state.time < 20) EXPECT_TRUE(stepper->advance(state, step));
  std::vector<double> longer;
  for (int k = 1; k <= rope_links; ++k)
    longer.push_back((state.x.col(k) - state.x.col(k - 1)).norm() - link_length);
  return longer;
}

// Along a vertical line a sweep is linear. With one sweep a step in two colors, here the links 2,
// 4, ... from the pin before 1, 3, ..., a rope rests where each vertex is lifted by the g h^2 that
// it falls: the links of the last color have their rest length, and link k of N of the first is
// longer by 2 (N - k + 1) g h^2. (A sweep from the pin downwards leaves (N - k) g h^2 in link k.)
TEST(PbdSubsteps, LeaveAHangingRopeTheStrainOfTheory) {
  for (const double step : {0.004, 0.002, 0.001, 0.0005}) {
    const auto longer = elongations("pbd_substeps", step, {});
    const double fall = testing::HangingRope::gravity * step * step;
    for (int k = 1; k <= rope_links; ++k)
      EXPECT_NEAR(longer[k - 1], k % 2 == 0 ? 2 * (rope_links - k + 1) * fall : 0, 1e-3 * fall)
          << "link " << k << ", " << step;
  }
}

// At rest the impulses are the loads, and what is soft in them leaves link k longer by
// load / (m_k omega^2), omega = 2 pi frequency / h, m_k = 1 / (w_a + w_b).
TEST(SoftStep, LeavesAHangingRopeTheElongationOfItsSprings) {
  for (const double step : {0.004, 0.001})
    for (const double frequency : {0.25, 0.5}) {
      SCOPED_TRACE("step " + std::to_string(step) + ", frequency " + std::to_string(frequency));
      const auto longer = elongations("soft_step", step, {{"frequency", frequency}});
      const double omega = 2 * std::numbers::pi * frequency / step;
      for (int k = 1; k <= rope_links; ++k) {
        const double load = (rope_links - k + 1) * vertex_mass * testing::HangingRope::gravity;
        const double wanted = load / ((k == 1 ? vertex_mass : vertex_mass / 2) * omega * omega);
        EXPECT_NEAR(longer[k - 1], wanted, 1e-3 * wanted) << "link " << k;
      }
    }
}

// A link that turns about a pin: the step's impulse is along its direction at the start, and the
// second stage leaves no velocity along it at the end.
TEST(SoftStep, LeavesNoVelocityAlongALink) {
  constexpr double step = 0.01;
  State state = testing::stretched_edge(1);
  state.v(1, 1) = 2;
  ASSERT_TRUE(make_stepper("soft_step", testing::one_edge(1, 1, {0}), {})->advance(state, step));
  EXPECT_NEAR(state.x(0, 1), 1, 1e-15);
  EXPECT_NEAR(state.x(1, 1), step * 2, 1e-15);
  const Eigen::Vector3d d = state.x.col(1), free(0, 2, 0);
  EXPECT_NEAR(state.v.col(1).dot(d), 0, 1e-15);
  EXPECT_NEAR((state.v.col(1) - (free - d.dot(free) / d.squaredNorm() * d)).norm(), 0, 1e-14);
}

}  // namespace
}  // namespace inextensible
