// What becomes of a run whose kinetic energy is not the ensemble's.
#include "harness/run/point_runner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "harness/judge/reference_routes.h"
#include "harness/run/calibration.h"
#include "harness/run/measure_point.h"

namespace harness {
namespace {

Reference small_reference(const SceneParameters& parameters) {
  const Scene scene = find_scene("drape")->build(parameters);
  Reference r;
  r.scene = "drape";
  r.parameters = parameters;
  r.times = sample_times(scene.duration);
  r.gap.assign(r.times.size(), 1);
  r.gap_max = r.gap;
  RouteRuns runs([](const std::string&) {});
  r.ensemble = compute_ensemble(scene, r.times, {.step = sample_interval / 20}, runs);
  return r;
}

TEST(PointRunner, ARunThatHangsOrShakesHasLostItsMotion) {
  const auto type = find_scene("drape");
  PointSpec spec;
  spec.sweep = "strain";
  spec.scene = "drape";
  spec.scene_parameters = complete_parameters(*type, {{"n", 5}, {"duration", 0.2}});
  spec.solver = "fast_projection";
  spec.strain_limit = 0.01;
  spec.step = 0.005;
  const Reference truth = small_reference(spec.scene_parameters);
  ASSERT_TRUE(truth.ensemble.known()) << truth.ensemble.unknown_because;
  const std::string folder = ::testing::TempDir() + "motion_references";
  std::filesystem::create_directories(folder);
  // What the ensemble has in kinetic energy, over its own, and how far its runs are apart in that.
  const auto against = [&](double times_as_much, double deviation) {
    Reference other = truth;
    for (ShapeStatistics& at : other.ensemble.mean) at.kinetic_energy *= times_as_much;
    for (double& d : other.ensemble.kinetic_deviation) d += deviation;
    std::ofstream(folder + "/" + reference_name("drape", spec.scene_parameters)) << to_json(other);
    RunLimits limits;
    limits.references = std::make_shared<ReferenceFolder>(folder);
    return run_point(spec, limits);
  };
  const PointResult good = against(1, 0);
  EXPECT_EQ(good.status, PointStatus::ok) << good.detail;
  EXPECT_NEAR(good.measures.kinetic_ratio, 1, 0.1);
  EXPECT_LT(good.measures.shape, 0.05);
  const PointResult hangs = against(2, 0);
  EXPECT_EQ(hangs.status, PointStatus::motion_lost);
  EXPECT_NEAR(hangs.measures.kinetic_ratio, good.measures.kinetic_ratio / 2, 1e-9);
  EXPECT_NE(hangs.detail.find("mean kinetic energy"), std::string::npos);
  EXPECT_EQ(against(0.5, 0).status, PointStatus::motion_lost) << "it shakes";
  EXPECT_EQ(against(2, 1).status, PointStatus::ok) << "the ensemble's runs are as far apart";
}

// Two runs of one command agree: what a search for a stiffness may take is work, not time.
TEST(PointRunner, ACalibrationIsCutOffByItsWorkAlone) {
  PointSpec spec;
  spec.sweep = "strain";
  spec.scene = "drape";
  spec.scene_parameters = complete_parameters(*find_scene("drape"), {{"n", 7}, {"duration", 0.5}});
  spec.solver = "vertex_block_descent";
  spec.strain_limit = 0.01;
  spec.step = 0.01;
  const PointResult whole = run_point(spec, {.timed = false});
  ASSERT_TRUE(whole.stiffness) << whole.detail;
  const auto [vertices, edges] = find_scene("drape")->counts(spec.scene_parameters);
  const double work = nominal_seconds(whole.work, edges);
  for (const double hopeless : {work / 2, work / 3}) {
    const PointResult again = run_point(spec, {.hopeless = hopeless, .timed = false});
    EXPECT_EQ(again.stiffness, whole.stiffness) << again.detail;
    EXPECT_EQ(again.calibration_runs, whole.calibration_runs);
  }
  const PointResult cut = run_point(spec, {.hopeless = work / 50, .timed = false});
  EXPECT_EQ(cut.status, PointStatus::skipped);
  EXPECT_FALSE(cut.stiffness);
}

}  // namespace
}  // namespace harness
