// What every method in every time stepper must hold, besides what `bench check` asks of it
// (conformance_test.cpp): coordinates and units, obstacles that move, refusals that leave nothing
// behind, honest random steps, no allocation.
#include <Eigen/Geometry>
#include <atomic>
#include <cstdlib>
#include <numbers>

#include "harness/stability/trial.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/systems/constraint_system.h"
#include "support/motion.h"
#include "support/param_name.h"

namespace {
std::atomic<long> allocations{0};
}

#if !defined(__SANITIZE_ADDRESS__)            // the sanitizer has a malloc of its own
extern "C" void* __libc_malloc(std::size_t);  // NOLINT(bugprone-reserved-identifier): glibc's own
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace inextensible {
namespace {

using Eigen::Vector3d, testing::for_seeds, testing::h, testing::moving_state, testing::Random,
    testing::random_mesh, testing::single_rounding, testing::uniform;
constexpr std::uint64_t seeds = 8;

struct EveryMethod : ::testing::TestWithParam<const char*> {
  const Backend& row = *find_backend(GetParam());
  const bool limits_strain = row.strain_control == StrainControl::strain_limit;

  std::unique_ptr<Stepper> make(const std::shared_ptr<const Problem>& problem, double limit,
                                Settings settings = {}) const {
    return make_stepper(GetParam(), problem, {limit, 1, std::move(settings)});
  }
};

INSTANTIATE_TEST_SUITE_P(All, EveryMethod, ::testing::ValuesIn(names::rows_that([](auto& row) {
                           return row.name != std::string_view("null");
                         })),
                         names::contestant_name);

// Two masses, one edge of length 1. A correction along the edge's own direction keeps the centre of
// mass and the direction: x_a' = centre - w_a / (w_a + w_b) d / |d|. SHAKE's goes along the
// direction at the start, by the smaller root s of |d - s d_start| = 1.
TEST_P(EveryMethod, ShortensOneEdgeByTheClosedForm) {
  if (row.strain_control == StrainControl::stiffness) GTEST_SKIP() << "an elastic edge";
  if (GetParam() == std::string_view("soft_step")) GTEST_SKIP() << "corrects a part of it";
  if (row.stepper == std::string_view("midpoint")) GTEST_SKIP() << "the direction turns";
  for_seeds(4 * seeds, [&](Random& random, std::uint64_t seed) {
    const double mass_a = uniform(random, 0.01, 1), mass_b = uniform(random, 0.01, 1);
    const auto problem = testing::one_edge(
        mass_a, mass_b,
        seed % 4 == 0 ? std::vector{static_cast<int>(seed / 4 % 2)} : std::vector<int>{});
    const double wa = problem->inverse_mass()[0], wb = problem->inverse_mass()[1];
    Positions start(3, 2);
    start.col(0) = testing::random_vector(random, 1);
    start.col(1) = start.col(0) + testing::random_vector(random, 1).normalized();
    Positions candidate = start;
    if (wa > 0) candidate.col(0) += testing::random_vector(random, 0.2);
    if (wb > 0) candidate.col(1) += testing::random_vector(random, 0.2);
    const Vector3d d = candidate.col(1) - candidate.col(0), e = start.col(1) - start.col(0);
    const double along = d.dot(e);
    const Vector3d correction =  // of d
        row.direction == Direction::start
            ? Vector3d((std::sqrt(along * along - d.squaredNorm() + 1) - along) * e)
            : Vector3d(d.normalized() - d);
    Positions expected = candidate;
    expected.col(0) -= wa / (wa + wb) * correction;
    expected.col(1) += wb / (wa + wb) * correction;
    State state{start, (candidate - start) / h, 0};
    ASSERT_TRUE(make(problem, 1e-11)->advance(state, h));
    EXPECT_LT((state.x - expected).norm(), single_rounding);
  });
}

// Rotations and translations, and the unit of mass: only ratios of masses matter to a filter;
// springs need their stiffness in the same unit.
TEST_P(EveryMethod, DependsOnNeitherCoordinatesNorUnits) {
  constexpr double factor = 1024;  // no rounding of its own in any precision
  for_seeds(seeds, [&](Random& random, std::uint64_t) {
    const auto mesh = random_mesh(random, 4, 4, 2);
    ProblemParts parts = testing::parts_of(*mesh.problem);
    for (double& mass : parts.mass) mass *= factor;
    const Settings grams = names::those_of(GetParam(), {{"stiffness", 1e4 * factor}});
    State state = moving_state(random, mesh, 3), heavy = state;
    const auto axis = testing::random_vector(random, 1).normalized();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(uniform(random, -3, 3), axis).toRotationMatrix();
    const Vector3d shift(3, -2, 5);
    State turned{(turn * state.x).colwise() + shift, turn * state.v, 0};
    const auto one = make(mesh.problem, 0.005), other = make(mesh.problem, 0.005),
               scaled = make(std::make_shared<const Problem>(parts), 0.005, grams);
    for (int step = 0; step < 3; ++step) {
      ASSERT_TRUE(one->advance(state, h));
      ASSERT_TRUE(other->advance(turned, h));
      ASSERT_TRUE(scaled->advance(heavy, h));
    }
    EXPECT_LT((turned.x - ((turn * state.x).colwise() + shift)).norm(), 3 * single_rounding);
    EXPECT_LT((heavy.x - state.x).norm(), single_rounding);
  });
}

// Squares overflow, or positions nearly so. Local methods may even then find permissible positions;
// a refusal leaves nothing behind in the stepper: the next step is that of one that has not refused
// (but for Gauss-Seidel's random numbers, which have moved on).
TEST_P(EveryMethod, SurvivesOverflowAndGoesOnAsIfNothingHadBeen) {
  // BDF2 drops its history where it is given a state that is not its last one.
  const int steps = row.stepper == std::string_view("bdf2") ? 1 : 2;
  for (const double speed : {1e160, 1e300})
    for_seeds(seeds, [&](Random& random, std::uint64_t) {
      const auto mesh = random_mesh(random, 4, 4, 1);
      State state = moving_state(random, mesh, 1), straight = state;
      State hopeless{state.x, state.v * speed, 2};
      if (State taken = hopeless; make(mesh.problem, 0.005)->advance(taken, h)) {
        EXPECT_TRUE(taken.x.allFinite());
        EXPECT_TRUE(!limits_strain || EdgeConstraints(*mesh.problem, 0.005).permissible(taken.x));
        return;
      }
      const auto stepper = make(mesh.problem, 0.005), never_refused = make(mesh.problem, 0.005);
      for (int step = 0; step < steps; ++step) {
        EXPECT_FALSE(stepper->advance(hopeless, h));
        ASSERT_TRUE(stepper->advance(state, h));
        ASSERT_TRUE(never_refused->advance(straight, h));
        if (row.method != std::string_view("gauss_seidel")) {
          EXPECT_EQ(state.x, straight.x) << "step " << step;
        }
      }
    });
}

// Graphs from trees to locked ones, masses over six decades, velocities over three, starts on and
// off the manifold, steps that are often absurd.
harness::Trial random_trial(Random& random) {
  const int n = 8 + static_cast<int>(random() % 9), pinned = static_cast<int>(random() % 3);
  // A framework of n vertices in space has about 3 n degrees of freedom: more edges lock it.
  const int room = n * (n - 1) / 2 - (n - 1) - 1;  // of the complete graph, pins apart
  const int extra = static_cast<int>(random() % static_cast<std::uint64_t>(std::min(2 * n, room)));
  const auto graph = testing::random_graph(random, n, extra, pinned, 1e-6);
  const bool on_the_manifold = random() % 2 == 0;
  const Positions start =
      on_the_manifold ? graph.x
                      : testing::perturbed(random, graph, std::pow(10, uniform(random, -3, 0)));
  harness::Trial trial;
  trial.scene.problem = graph.problem;
  trial.scene.start = moving_state(random, graph, std::pow(10, uniform(random, -1, 2)));
  trial.scene.start.x = start;
  trial.step = std::pow(10, uniform(random, -4, -1));
  trial.strain_limit = std::pow(10, uniform(random, -4, -1));
  trial.energy_tolerance = -1;  // what these starts release has no useful bound
  // Locked graphs have multipliers that cancel; accepted pivots bound their size.
  trial.momentum_tolerance = 1e-5;
  static_assert(1e-5 > 1e-16 / ConstraintSystem::least_pivot);
  return trial;
}

// A method's own iteration limit is meant for real problems; here most of them are hopeless.
Settings impatient(std::string_view method) {
  const std::pair<const char*, double> limits[] = {
      {"yarn_projection", 20}, {"fast_projection_adaptive", 20},
      {"jacobi", 300},         {"gauss_seidel", 300},
      {"admm", 3000},          {"augmented_vbd", 3000}};
  for (const auto& [prefix, most] : limits)
    if (method.starts_with(prefix)) return {{"max_iterations", most}};
  return {};
}

// Whatever happens: an honest step or a clean refusal. RANDOM_CASES=n runs n cases a method.
TEST_P(EveryMethod, GivesAnHonestStepOrACleanRefusalInRandomCases) {
  if (!row.contestant) GTEST_SKIP() << "takes no such masses";
  const char* wanted = std::getenv("RANDOM_CASES");
  const int cases = wanted ? std::atoi(wanted) : testing::trials(1000);
  int steps = 0;
  for (int seed = 1; seed <= cases; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const harness::Trial trial = random_trial(random);
    const auto stepper = make(trial.scene.problem, trial.strain_limit, impatient(GetParam()));
    harness::TrialResult judged;
    harness::TrialJudge judge(trial, row, *stepper, judged);
    State state = trial.scene.start;
    bool goes_on = true;
    for (int i = 0; i < 4 && goes_on; ++i) {
      const State before = state;
      judge.before(state, {});
      const StepResult step = stepper->advance(state, trial.step);
      if (!step) {
        EXPECT_TRUE(state.x == before.x && state.v == before.v && state.time == before.time);
        EXPECT_STRNE(step.detail, "");
        break;
      }
      ++steps;
      goes_on = judge.after(stepper->filtered_positions(), state, trial.step);
    }
    // Springs may stretch as far as they like.
    const harness::Outcome outcome = judge.finish();
    if (outcome == harness::Outcome::diverged && !limits_strain) continue;
    EXPECT_EQ(outcome, harness::Outcome::survived) << "seed " << seed << ": " << judged.detail;
  }
  EXPECT_GT(steps, cases / 2) << "hardly any step was taken: this tests nothing";
}

// A method whose row says that it is another one on a chain takes the same steps, bit for bit.
TEST_P(EveryMethod, IsTheOtherMethodOnAChainIfItSaysSo) {
  if (!*row.same_on_chains) GTEST_SKIP() << "does not say so";
  const harness::Scene scene = harness::built_scene("chain", {{"n", 40}});
  for (const double strain_limit : {0.05, 0.001}) {
    const auto one = make(scene.problem, strain_limit);
    const auto other = make_stepper(row.same_on_chains, scene.problem, {strain_limit});
    State a = scene.start, b = scene.start;
    for (int step = 0; step < 100; ++step) {
      ASSERT_TRUE(one->advance(a, 0.005));
      ASSERT_TRUE(other->advance(b, 0.005));
      ASSERT_EQ(a.x, b.x) << "step " << step;
    }
    EXPECT_GT((a.x - scene.start.x).norm(), 0.1) << "nothing has moved";
  }
}

// Vertices without edges and a net that moves as a whole fall exactly, pinned vertices stay where
// they are, with every word that one of the method's settings may have: each row states the time
// that its velocities are of.
TEST_P(EveryMethod, LetsWhatNoEdgeHoldsFallExactly) {
  std::vector<Settings> variants{{}};
  for (const SettingInfo& info : row.settings)
    for (const char* word : info.choices) variants.push_back({{info.name, std::string(word)}});
  Random random(3);
  std::vector<testing::RandomMesh> meshes{random_mesh(random, 5, 5, 0)};
  const std::pair<int, std::vector<int>> without_edges[] = {
      {1, {}}, {1, {0}}, {3, {}}, {3, {0, 1, 2}}, {3, {1}}};  // vertices, and which are pinned
  for (const auto& [vertices, pinned] : without_edges) {
    const Positions x = Positions::Random(3, vertices);
    const std::vector<double> mass(vertices, 0.5);
    meshes.push_back(
        {std::make_shared<const Problem>(testing::parts_at_rest(x, {}, mass, pinned)), x});
  }
  for (const Settings& settings : variants) {
    SCOPED_TRACE(settings.empty() ? "" : std::get<std::string>(settings.begin()->second));
    for (const auto& [weightless, x] : meshes) {
      ProblemParts parts = testing::parts_of(*weightless);
      parts.gravity = {0, -9.81, 0};
      const auto problem = std::make_shared<const Problem>(parts);
      std::unique_ptr<Stepper> stepper;
      try {
        stepper = make(problem, 0.01, settings);
      } catch (const std::invalid_argument&) {
        ASSERT_FALSE(settings.empty());
        continue;  // a clean refusal, of chain solvers for instance
      }
      State state{x, Positions::Zero(3, x.cols()), 0};
      Positions expected = x;
      for (int v = 0; v < x.cols(); ++v) {
        if (problem->inverse_mass()[v] == 0) continue;
        state.v.col(v) << 1, 2, 3;
        expected.col(v) += 0.5 * state.v.col(v) + 0.5 * 0.25 * parts.gravity;
      }
      if (row.velocities == Velocities::half_step) state = start_half_step_back(*problem, state, h);
      for (int i = 0; i < 50; ++i) ASSERT_TRUE(stepper->advance(state, h));
      EXPECT_LT((state.x - expected).cwiseAbs().maxCoeff(), 1e-12);
      for (const int v : parts.pinned) EXPECT_EQ(state.x.col(v), x.col(v));
    }
  }
}

// Cloth that falls onto a ball, free or pinned beside it, sees no difference between a ball at rest
// and both in the same steady motion, but for what iterations stop at: a method that did not carry
// contacts along would be wrong by 0.1, one that left pins behind by 0.6.
TEST_P(EveryMethod, SeesNoSteadyMotionThatItShares) {
  if (!row.contestant || !row.takes_collider) GTEST_SKIP() << "takes no obstacle";
  constexpr double tick = 1.0 / 128;  // s, so that times are exact
  const Vector3d velocity(0.7, -0.4, 1.1);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()).toRotationMatrix();
  // Made once for all methods: one takes a second with sanitizers.
  static std::map<std::pair<std::uint64_t, bool>, std::shared_ptr<const TriangleCollider>> balls;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto run = [&](bool moves) {
      Random random(seed);
      const Vector3d middle(2, -1.15 + uniform(random, -0.1, 0.1), 1.5);
      const auto mesh = testing::random_mesh(random, 4, 5, seed == 0);
      ProblemParts parts = testing::parts_of(*mesh.problem);
      parts.gravity = {0, -9.81, 0};
      auto& collider = balls[{seed, moves}];
      if (!collider) {
        // In coordinates of its own that are turned, which its pose turns back.
        TriangleMesh ball = icosphere(middle, 0.9, 2);
        if (moves)
          for (Vector3d& v : ball.vertices) v = turned.transpose() * v;
        collider = std::make_shared<const TriangleCollider>(ball, 0.3);
      }
      parts.collider = collider;
      if (moves) parts.body_motion = [=](double time) { return Pose{turned, time * velocity}; };
      parts.pins_follow_body = moves;
      State state{mesh.x, Positions::Zero(3, mesh.x.cols()), 0};
      if (moves) state.v.colwise() += velocity;
      const auto stepper =
          make_stepper(row.name, std::make_shared<const Problem>(parts),
                       {0.01, 1, names::those_of(row.name, {{"stiffness", 2000.0}}), &state});
      for (int step = 0; step < 56; ++step) EXPECT_TRUE(stepper->advance(state, tick));
      EXPECT_GT(stepper->work().contacts, 0) << "nothing touched: this tests nothing";
      if (moves) state.x.colwise() -= state.time * velocity;
      return state.x;
    };
    EXPECT_LT((run(true) - run(false)).cwiseAbs().maxCoeff(), 5e-3);
  }
}

// Nothing is allocated inside a step after warm-up. Counted at malloc itself, so that Eigen's and
// the libraries' memory is seen too; UMFPACK, which allocates by design, is no method's default.
TEST_P(EveryMethod, AllocatesNothingInsideAStepAfterWarmUp) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "malloc belongs to the sanitizer";
#endif
  if (!row.contestant) GTEST_SKIP() << "does not promise it";
  // Forces along the start of a step want short ones.
  const double step = row.direction == Direction::start ? 0.0005 : 0.002;
  for (const auto& scene :
       {harness::built_scene("chain", {{"n", 80}}), harness::built_scene("drape", {{"n", 15}})}) {
    if (part_not_taken(row, *scene.problem)) continue;
    const auto stepper = make(scene.problem, 0.01);
    State state = scene.start;
    // Long enough for every method to have solved its first linear system.
    for (int i = 0; i < 60; ++i) ASSERT_TRUE(stepper->advance(state, step));
    const long before = allocations;
    ASSERT_GT(before, 0) << "the counter does not count";
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(stepper->advance(state, step));
    EXPECT_EQ(allocations - before, 0) << scene.problem->vertices() << " vertices";
  }
}

}  // namespace
}  // namespace inextensible
