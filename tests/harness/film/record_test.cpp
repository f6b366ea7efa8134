// Runs of films: at which step they are taken, what is said of them, and that they end.
#include <gtest/gtest.h>

#include "harness/film/recording.h"
#include "solvers/registry.h"

namespace harness {
namespace {

FilmRun filmed(const std::string& scene, const SceneParameters& given, const Contestant& contestant,
               double limit, std::optional<double> step) {
  FilmSpec spec;
  spec.scene = scene;
  spec.parameters = complete_parameters(*find_scene(scene), given);
  spec.solvers = {contestant};
  spec.strain_limits = {limit};
  spec.step = step;
  Recording recording = record(
      spec, [] { return false; }, [](auto&&...) {});
  return recording.takes.at(0);
}

// Throws one vertex upwards, in steps that are longer than its own limit.
struct Thrower final : inextensible::VelocityFilter {
  static constexpr double longest_step = 0.005;  // s
  inextensible::StepResult apply(const inextensible::Positions&, double h, inextensible::Iterate x,
                                 inextensible::WorkCounters&) override {
    if (h > longest_step) x.positions().rightCols<1>() += Eigen::Vector3d(0, 0.1, 0);
    return {};
  }
};

const bool thrower_is_there = [] {
  const inextensible::Backend row{
      .name = "thrower",
      .summary = "adds energy in long steps",
      .strain_control = inextensible::StrainControl::none,
      .contestant = false,
      .settings = {},
      .make_filter = [](const inextensible::Problem&, const inextensible::BackendOptions&,
                        inextensible::Along) -> std::unique_ptr<inextensible::VelocityFilter> {
        return std::make_unique<Thrower>();
      }};
  inextensible::add_backends({&row, 1});
  return true;
}();

TEST(Films, TakeAStepAtWhichNoEnergyIsGainedUnlessOneIsGiven) {
  ASSERT_TRUE(thrower_is_there);
  const auto chain = [](std::optional<double> step) {
    return filmed("chain", {{"n", 13}}, {"thrower", "thrower"}, 0.01, step);
  };
  const FilmRun given = chain(default_step), chosen = chain({});
  EXPECT_DOUBLE_EQ(given.step, 1.0 / 120);
  ASSERT_NE(given.energy_gained, "") << "a step that is given is taken, and the run is marked";
  EXPECT_EQ(chosen.energy_gained, "");
  EXPECT_DOUBLE_EQ(chosen.step, 1.0 / 240);
  EXPECT_EQ(chosen.frames.size(), given.frames.size());
}

// A body that moves does work, so that sweeps do not judge energy there. Thrown over the body, the
// skirt gains nine times what the body can do.
TEST(Films, JudgeEnergyBesideABodyThatMoves) {
  const auto garment = [](std::optional<double> step) {
    return filmed("garment", {{"n", 40}, {"duration", 1}},
                  {"yarn_projection@bdf2", "yarn_projection@bdf2"}, 0.01, step);
  };
  const FilmRun chosen = garment({});
  EXPECT_EQ(chosen.energy_gained + chosen.detail, "");
  const FilmRun fine = garment(0.001);
  EXPECT_EQ(fine.energy_gained + fine.detail, "");
  const auto mean_height = [](const FilmRun& take) { return take.frames.back().row(1).mean(); };
  EXPECT_NEAR(mean_height(chosen), mean_height(fine), 0.04) << "m; the skirt is 0.4 long";
}

// Each step takes a hundred thousand passes: by default it would be refused, halved and so on.
TEST(Films, EndRunsWhoseStepsTakeTooMuchWork) {
  const FilmRun take =
      filmed("chain", {{"n", 80}}, {"jacobi", "jacobi", {{"max_iterations", 1e9}}}, 1e-8, 0.01);
  EXPECT_NE(take.detail.find("iterations for"), std::string::npos) << take.detail;
  EXPECT_LT(take.frames.size(), 31U);
}

}  // namespace
}  // namespace harness
