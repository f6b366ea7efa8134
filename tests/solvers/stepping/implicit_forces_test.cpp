// Shear, bending and drag at the end of the step: against closed forms, and against each other.
#include <gtest/gtest.h>

#include "harness/scenes/meshes.h"
#include "solvers/registry.h"

namespace inextensible {
namespace {

using harness::Scene;

constexpr double g = 9.81;

// A horizontal yarn in n vertices, clamped at the first two, length 1 m from the middle of its
// first link on; Gamma = rho g L^3 / EI (Romero et al. 2021; Peirce 1930). Its end vertex is half a
// link's mass, so that every link bears what lies beyond its middle.
Scene cantilever(int n, double gamma) {
  const double link = 1 / (n - 1.5), density = 0.1, rigidity = density * g / gamma;
  harness::Draft yarn(n, {{"gravity", g}, {"duration", 15}});
  ProblemParts& parts = yarn.parts;
  parts.mass.assign(n, density * link);
  parts.mass.back() *= 0.5;
  parts.pinned = {0, 1};
  for (int i = 1; i + 1 < n; ++i) {
    yarn.constrain(i, i + 1, link);
    parts.bending.push_back(yarn_bending(i - 1, i, i + 1, link, link, rigidity));
  }
  for (const double m : parts.mass) parts.drag.push_back(6 * m);
  parts.implicit_forces = true;
  for (int i = 0; i < n; ++i) yarn.scene.start.x(0, i) = link * (i - 0.5);
  return finished(std::move(yarn));
}

void run(Stepper& stepper, State& state, double h, double time) {
  for (int i = 0; i < std::lround(time / h); ++i) {
    const StepResult result = stepper.advance(state, h);
    ASSERT_TRUE(result) << to_string(result.status) << ", " << result.detail << ", step " << i;
  }
}

// Reach and drop of the tip, over the length: EI th'' = -rho g (L - s) cos th.
TEST(Cantilever, HangsAsTheHeavyElasticaDoesByEveryRouteThatBendingTakes) {
  struct Elastica {
    double gamma, reach, drop;
  };
  const Elastica slack{1, 0.99125, 0.12347}, bent{10, 0.65635, 0.70020},
      hanging{100, 0.15922, 0.93752};
  const struct {
    const char* solver;
    Elastica exact;
    int n;
    double h;
    Settings settings;
  } cases[] = {{"fast_projection", slack, 21, 0.02, {}},
               {"fast_projection", slack, 81, 0.02, {}},
               {"fast_projection", bent, 21, 0.02, {}},
               {"fast_projection", bent, 81, 0.02, {}},
               {"fast_projection", hanging, 21, 0.02, {}},
               {"fast_projection", hanging, 81, 0.02, {}},
               {"implicit_springs", bent, 31, 0.02, {{"stiffness", 1e5}}},
               {"fast_projection@bdf2", bent, 31, 0.02, {}},
               {"icd", bent, 31, 0.02, {}},
               {"shake", bent, 31, 0.0025, {}}};
  for (const auto& [solver, exact, n, h, settings] : cases) {
    SCOPED_TRACE(std::string(solver) + ", Gamma " + std::to_string(exact.gamma) + ", " +
                 std::to_string(n) + " vertices");
    const Scene scene = cantilever(n, exact.gamma);
    State state = scene.start;
    run(*make_stepper(solver, scene.problem, {1e-6, 1, settings}), state, h, 15);
    EXPECT_NEAR(state.x(0, n - 1), exact.reach, 0.02 * std::max(exact.reach, exact.drop));
    EXPECT_NEAR(-state.x(1, n - 1), exact.drop, 0.02 * std::max(exact.reach, exact.drop));
    EXPECT_LT(state.v.cwiseAbs().maxCoeff(), 1e-4);
  }
}

// A square of cloth, stiff enough in shear and bending to matter, that hangs by two corners: those
// of a diagonal, between which no row is taut.
Scene cloth(bool implicit) {
  harness::Draft square = harness::vertex_square({{"n", 5},
                                                  {"side", 1},
                                                  {"density", 0.2},
                                                  {"gravity", g},
                                                  {"shear", 5},
                                                  {"bending", 1e-3},
                                                  {"drag", 0.1},
                                                  {"duration", 1}},
                                                 0);
  square.parts.pinned = {0, 24};
  square.parts.implicit_forces = implicit;
  return finished(std::move(square));
}

Positions after(const char* solver, const Scene& scene, double h, double time,
                const Settings& settings = {}) {
  const auto stepper = make_stepper(solver, scene.problem, {1e-9, 1, settings});
  State state = scene.start;
  run(*stepper, state, h, time);
  return state.x;
}

TEST(ImplicitForces, HaveTheOrderOfTheirStepper) {
  const Scene scene = cloth(true);
  const Settings conserving{{"spectral_radius", 1.0}};
  const struct {
    const char* solver;
    double order;
    Settings settings;
  } cases[] = {{"fast_projection", 1, {}},
               {"fast_projection@bdf2", 2, {}},
               {"fast_projection@midpoint", 2, conserving},
               {"rattle", 2, {}}};
  for (const auto& [solver, order, settings] : cases) {
    const Positions a = after(solver, scene, 1.0 / 800, 0.2, settings),
                    b = after(solver, scene, 1.0 / 1600, 0.2, settings),
                    c = after(solver, scene, 1.0 / 3200, 0.2, settings);
    EXPECT_NEAR(std::log2((a - b).norm() / (b - c).norm()), order, 0.25) << solver;
  }
}

TEST(ImplicitForces, TendToTheSameMotionAsExplicitOnes) {
  const double h = 1.0 / 6400, time = 0.2;
  const Positions x = after("fast_projection@bdf2", cloth(true), h, time);
  const Positions y = after("fast_projection@bdf2", cloth(false), h, time);
  EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 3e-5);
  for (const bool implicit : {false, true}) {
    const Positions rattle = after("rattle", cloth(implicit), h, time);
    EXPECT_LT((x - rattle).cwiseAbs().maxCoeff(), 3e-5) << implicit;
  }
  EXPECT_GT((x - cloth(true).start.x).cwiseAbs().maxCoeff(), 0.05) << "hardly anything moved";
}

// A vertex of 0.5 kg on a spring of length 1 that is stretched to 1.1, after one step of 0.05 s.
double after_a_step(const char* solver, double stiffness, double speed, const Settings& settings) {
  ProblemParts parts;
  parts.mass = {1, 0.5};
  parts.pinned = {0};
  parts.gravity.setZero();
  parts.shear = Springs{{{0, 1}}, {1}, {stiffness}};
  parts.implicit_forces = true;
  State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
  state.x(0, 1) = 1.1;
  state.v(0, 1) = speed;
  const auto problem = std::make_shared<const Problem>(parts);
  EXPECT_TRUE(make_stepper(solver, problem, {0.01, 1, settings})->advance(state, 0.05));
  return state.x(0, 1) - 1;
}

// Backward Euler's step, to the digits of a factor in single precision; the midpoint rule leaves
// -rho of a fast vibration.
TEST(ImplicitForces, DampASpringAsTheirStepperDoes) {
  const double h = 0.05, flight = 0.1 + h * 0.3;
  EXPECT_NEAR(after_a_step("fast_projection", 2000, 0.3, {}), flight / (1 + h * h * 2000 / 0.5),
              1e-7 * flight);
  for (const double rho : {0.0, 0.3, 1.0})
    EXPECT_NEAR(after_a_step("fast_projection@midpoint", 2e9, 0, {{"spectral_radius", rho}}),
                -rho * 0.1, 1e-7)
        << rho;
}

TEST(Drag, LetsFallAtTheSpeedAtWhichItBearsTheWeight) {
  for (const bool implicit : {false, true})
    for (const char* solver :
         {"fast_projection", "fast_projection@bdf2", "fast_projection@midpoint", "rattle",
          "soft_step", "implicit_springs"}) {
      ProblemParts parts;
      parts.mass = {0.5, 2};
      parts.drag = {1, 4};
      parts.implicit_forces = implicit;
      State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
      const auto stepper =
          make_stepper(solver, std::make_shared<const Problem>(parts), {0.01, 1, {}});
      run(*stepper, state, 0.01, 8);
      for (int i = 0; i < 2; ++i) EXPECT_NEAR(state.v(1, i), -0.5 * g, 1e-5) << solver << implicit;
    }
}

}  // namespace
}  // namespace inextensible
