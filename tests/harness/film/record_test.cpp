// Runs of films: at which step they are taken, what is said of them, and that they end.
#include <gtest/gtest.h>

#include "harness/film/recording.h"

namespace harness {
namespace {

Take filmed(const std::string& scene, const SceneParameters& given, const Contestant& contestant,
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

TEST(Films, TakeAStepAtWhichNoEnergyIsGainedUnlessOneIsGiven) {
  // Links that are brought to their length almost exactly, by many passes: twice the bound at 1/120
  // s.
  const Contestant contestant{"fast_projection@bdf2",
                              "fast_projection@bdf2",
                              {{"first_forcing", 0.0395},
                               {"smoothing_sweeps", 111.0},
                               {"smoothing_target", 0.0953},
                               {"sweeps_before", 1.0},
                               {"target", 0.021}}};
  const auto patch = [&](std::optional<double> step) {
    return filmed("patch", {{"n", 13}}, contestant, 0.01, step);
  };
  const Take given = patch(default_step), chosen = patch({});
  EXPECT_DOUBLE_EQ(given.step, 1.0 / 120);
  ASSERT_NE(given.energy_gained, "") << "a step that is given is taken, and the run is marked";
  EXPECT_EQ(chosen.energy_gained, "");
  EXPECT_LT(chosen.step, given.step);
  EXPECT_EQ(chosen.frames.size(), given.frames.size());
}

// A body that moves does work, so that sweeps do not judge energy there. Thrown over the body, the
// skirt gains nine times what the body can do.
TEST(Films, JudgeEnergyBesideABodyThatMoves) {
  const auto garment = [](std::optional<double> step) {
    return filmed("garment", {{"n", 40}, {"duration", 1}}, {"strips@bdf2", "strips@bdf2"}, 0.01,
                  step);
  };
  const Take chosen = garment({});
  EXPECT_EQ(chosen.energy_gained + chosen.detail, "");
  const Take fine = garment(0.001);
  EXPECT_EQ(fine.energy_gained + fine.detail, "");
  const auto mean_height = [](const Take& take) { return take.frames.back().row(1).mean(); };
  EXPECT_NEAR(mean_height(chosen), mean_height(fine), 0.04) << "m; the skirt is 0.4 long";
}

// Each step takes a hundred thousand passes: by default it would be refused, halved and so on.
TEST(Films, EndRunsWhoseStepsTakeTooMuchWork) {
  const Take take =
      filmed("chain", {{"n", 80}}, {"jacobi", "jacobi", {{"max_iterations", 1e9}}}, 1e-8, 0.01);
  EXPECT_NE(take.detail.find("iterations for"), std::string::npos) << take.detail;
  EXPECT_LT(take.frames.size(), 31U);
}

}  // namespace
}  // namespace harness
