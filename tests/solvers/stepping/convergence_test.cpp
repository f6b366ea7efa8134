// Orders of convergence against the pendulum in angles, energy behaviour, and BDF2's identities.
#include "harness/base/statistics.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference.h"
#include "harness/scenes/pendulum.h"
#include "solvers/stepping/step_controller.h"
#include "solvers/systems/constrained_acceleration.h"
#include "support/motion.h"
#include "support/param_name.h"

namespace harness {
namespace {

using inextensible::make_stepper, inextensible::Positions, inextensible::Settings,
    inextensible::State, inextensible::Stepper;

constexpr double stretch = 0.32;  // s, of smooth motion
constexpr double tight = 1e-11;   // strain limit: slack must not matter

Scene short_chain() { return built_scene("chain", {{"n", 8}}); }

// To the end of the stretch; every other step is `other` times as long.
void run(Stepper& stepper, State& state, double h, double other = 1) {
  for (int i = 0; state.time < stretch - 1e-9; ++i)
    ASSERT_TRUE(stepper.advance(state, i % 2 == 0 ? h : other * h));
  ASSERT_NEAR(state.time, stretch, 1e-9);
}

// Slope of the error at the end of the stretch over five steps. staggered: velocities begin half a
// step earlier, as the leapfrog form of SHAKE wants them.
Slope order(const char* solver, const Settings& settings = {}, bool staggered = false,
            double other = 1) {
  const Scene scene = short_chain();
  Pendulum pendulum({std::vector<double>(7, 1.0 / 8), std::vector<double>(7, 1.0 / 7), 9.81},
                    std::vector<double>(7, 0.0));
  pendulum.advance(stretch, 1e-13);
  std::vector<double> steps, errors;
  for (double h = stretch / 40; steps.size() < 5; h /= 2) {
    const auto stepper = make_stepper(solver, scene.problem, {tight, 1, settings});
    State state = scene.start;
    if (staggered) state = inextensible::start_half_step_back(*scene.problem, state, h);
    run(*stepper, state, h, other);
    steps.push_back(h);
    errors.push_back(rms_distance(scene, state.x, pendulum.positions()));
  }
  return log_log_slope(steps, errors);
}

TEST(Order, IsThatOfTheMethodInItsOwnStepper) {
  const struct {
    const char* solver;
    double order, tolerance;
    Settings settings = {};
    bool staggered = false;
  } cases[] = {{"fast_projection", 1, 0.1}, {"icd", 1, 0.1, {{"direction_tolerance", 1e6}}},
               {"shake", 2, 0.1, {}, true}, {"shake", 1, 0.1},
               {"rattle", 2, 0.1},          {"jacobi", 1, 0.15},
               {"gauss_seidel", 1, 0.15},   {"gauss_seidel_colored", 1, 0.15}};
  for (const auto& [solver, expected, tolerance, settings, staggered] : cases) {
    const Slope slope = order(solver, settings, staggered);
    EXPECT_NEAR(slope.value, expected, tolerance) << solver << " +- " << slope.half_width;
  }
}

// Every method that keeps a strain limit, here next to nothing, in a stepper of second order.
struct PairOrder : ::testing::TestWithParam<const char*> {
  double of(double radius) const {
    const Settings wanted{{"target", 0.0}, {"spectral_radius", radius}};
    return order(GetParam(), inextensible::names::those_of(GetParam(), wanted)).value;
  }
};

// The midpoint rule is of second order if it keeps all of the energy; else a part of backward
// Euler's error is there.
TEST_P(PairOrder, IsTheSteppers) {
  EXPECT_NEAR(of(1), 2, 0.25);
  if (std::string_view(GetParam()).ends_with("@midpoint")) {
    EXPECT_NEAR(of(0.5), 1, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Pairs, PairOrder,
                         ::testing::ValuesIn(inextensible::names::rows_that([](auto& row) {
                           return std::string_view(row.name) != row.method &&
                                  row.strain_control == inextensible::StrainControl::strain_limit;
                         })),
                         inextensible::names::contestant_name);

// A net that turns without weight, 0.1 to 0.4 rad a step, for 10 rad. The midpoint rule keeps its
// energy to the third power of the angle a step; directions of a step's end lose it to the first.
TEST(Energy, OfATurningNetIsKeptByDirectionsOfTheMiddle) {
  const Scene scene = built_scene("spinning_net", {{"n", 7}});
  const double start = total_energy(*scene.problem, scene.start);
  const auto lost = [&](const char* solver, const Settings& settings, double h) {
    State state = scene.start;
    run(*make_stepper(solver, scene.problem, {1e-9, 1, settings}), state, h);
    return 1 - total_energy(*scene.problem, state) / start;
  };
  const Settings conserving{{"spectral_radius", 1.0}, {"target", 0.0}};
  std::vector<double> steps, errors;
  for (double h = 0.02; steps.size() < 3; h /= 2) {
    steps.push_back(h);
    errors.push_back(std::abs(lost("yarn_projection@midpoint", conserving, h)));
    EXPECT_LT(errors.back(), 0.05 * lost("yarn_projection", {}, h)) << "h = " << h;
  }
  EXPECT_GT(log_log_slope(steps, errors).value, 1.8);
}

// 10 kg at the end of a rope of 0.1 kg, released level: where strain limits alone would call a run
// good that throws the weight up, the controller ends it.
TEST(Energy, OfAHeavyEndDoesNotRiseWhileStepsAreOk) {
  inextensible::ProblemParts parts;
  constexpr int links = 20;
  parts.mass.assign(links + 1, 0.1 / (links + 1));
  parts.mass.back() = 10;
  parts.pinned = {0};
  State start{Positions::Zero(3, links + 1), Positions::Zero(3, links + 1)};
  for (int i = 1; i <= links; ++i) {
    parts.edges.push_back({i - 1, i});
    parts.rest_length.push_back(1.0 / links);
    start.x(0, i) = static_cast<double>(i) / links;
  }
  const auto problem = std::make_shared<const inextensible::Problem>(parts);
  const double weight = 9.81 * problem->total_mass();  // times a length of 1 m
  int ended = 0;
  for (const char* name : {"fast_projection", "shake", "icd", "yarn_projection@bdf2"})
    for (const double h : {1.0 / 60, 1.0 / 240}) {
      State state = start;
      const auto stepper = make_stepper(name, problem, {.strain_limit = 0.01, .start = &start});
      inextensible::StepController controller(*stepper, {.largest = h});
      while (state.time < 1) {
        const auto result = controller.advance(state);
        ended += result.status == inextensible::Status::gained_energy ? 1 : 0;
        if (!result) break;
        double energy = 0;
        for (int v = 1; v <= links; ++v)
          energy += parts.mass[v] * (0.5 * state.v.col(v).squaredNorm() + 9.81 * state.x(1, v));
        ASSERT_LT(energy, 0.55 * weight) << name;
      }
    }
  EXPECT_GT(ended, 0);
}

TEST(Bdf2, RestartsFromAStateThatIsNotItsOwnAndInAStepGrownMoreThanTwofold) {
  const auto problem = inextensible::testing::one_edge(1, 2);
  for (const auto& [slowed, h, restarts] :
       {std::tuple(0.5, 0.01, true), std::tuple(1.0, 0.03, true), std::tuple(1.0, 0.02, false)}) {
    const auto used = make_stepper("fast_projection@bdf2", problem, {1e-12}),
               fresh = make_stepper("fast_projection@bdf2", problem, {1e-12});
    State state = inextensible::testing::stretched_edge(1);
    state.v(1, 1) = 4;  // spins
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(used->advance(state, 0.01));
    state.v *= slowed;
    State other = state;
    ASSERT_TRUE(used->advance(state, h));
    ASSERT_TRUE(fresh->advance(other, h));
    EXPECT_EQ(state.x == other.x && state.v == other.v, restarts);
  }
}

TEST(Bdf2, KeepsItsOrderWhenTheStepChanges) {
  EXPECT_NEAR(order("fast_projection@bdf2", {}, false, 1.5).value, 2, 0.25);
}

// What hits the ground must not bounce off it by a velocity extrapolated over the impact.
TEST(Bdf2, DoesNotBounceOffACollider) {
  const Scene scene = built_scene("drape", {{"n", 5}, {"side", 0.05}, {"gap", 0.05}, {"shear", 0}});
  const auto stepper = make_stepper("fast_projection@bdf2", scene.problem, {1e-4});
  State state = scene.start;
  double highest_after = -1;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(stepper->advance(state, 0.002));
    const double rise = state.v.row(1).maxCoeff();
    if (stepper->work().contacts > 0) highest_after = std::max(highest_after, rise);
  }
  EXPECT_GT(stepper->work().contacts, 0);
  EXPECT_LT(highest_after, 0.1);  // it arrives at 1 m/s
}

}  // namespace
}  // namespace harness
