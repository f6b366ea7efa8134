// Films: which runs are flagged, and that every run ends.
#include "harness/film/film.h"

#include <gtest/gtest.h>

#include "support/scenes.h"

namespace harness {
namespace {

FilmRun filmed(const std::string& scene, const SceneParameters& given, const Contestant& contestant,
               double limit, double step) {
  const FilmSpec spec{.scene = scene,
                      .parameters = testing::parameters(scene, given),
                      .solvers = {contestant},
                      .strain_limits = {limit},
                      .step = step,
                      .frames_per_second = 32};
  return record(spec, [](auto&&...) {}).takes.at(0);
}

// Edges that shake between limits of 10 % bring energy back step by step. A body that moves does
// work, so that energy is not judged there.
TEST(Films, SayWhichRunsGainEnergy) {
  const FilmRun shaking =
      filmed("drape", {{"n", 15}}, {"fast_projection", "fast_projection"}, 0.1, 1.0 / 1600);
  EXPECT_DOUBLE_EQ(shaking.step, 1.0 / 1600);
  EXPECT_NE(shaking.energy_gained, "");
  const FilmRun worn = filmed("garment", {{"n", 40}, {"duration", 1}},
                              {"yarn_projection@bdf2", "yarn_projection@bdf2"}, 0.01, 0.001);
  EXPECT_EQ(worn.energy_gained + worn.detail, "");
}

// Each step takes a hundred thousand passes: by default it would be refused, halved and so on.
TEST(Films, EndRunsWhoseStepsTakeTooMuchWork) {
  const FilmRun take =
      filmed("chain", {{"n", 80}}, {"jacobi", "jacobi", {{"max_iterations", 1e9}}}, 1e-8, 0.01);
  EXPECT_NE(take.detail.find("iterations for"), std::string::npos) << take.detail;
  EXPECT_LT(take.frames.size(), 33U);
}

}  // namespace
}  // namespace harness
