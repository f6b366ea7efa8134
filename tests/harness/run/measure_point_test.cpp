// Real runs: samples, frames, and contact; and, with artificial noise, what is taken again.
#include "harness/run/measure_point.h"

#include <gtest/gtest.h>

#include <numeric>

#include "harness/run/calibration.h"
#include "harness/run/fake_machine.h"
#include "harness/run/machine_noise.h"
#include "harness/run/point_runner.h"
#include "support/effort.h"
#include "support/param_name.h"

namespace harness {
namespace {

TEST(Batches, ASampleOfAShortRunTakesAtLeastTwentyMilliseconds) {
  PointResult point = run_point(spec_at("chain", {{"n", 10}}, "gauss_seidel", 0.001), {});
  ASSERT_TRUE(point.ok()) << point.detail;
  for (int i = 1; i < 4; ++i) add_sample(point, run_point, {});
  ASSERT_EQ(point.samples.size(), 4u);
  ASSERT_EQ(point.sample_runs.size(), 4u);
  ASSERT_EQ(point.cpu_samples.size(), 4u);
  ASSERT_EQ(point.filter_samples.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double a_run = point.samples[i] * point.spec.step * point.steps_planned;
    EXPECT_GE(a_run * point.sample_runs[i], 0.2 * least_sample);  // the shortest run counts
    EXPECT_GT(point.cpu_samples[i], 0);
    // Reads of the clock between blocks of steps are part of it, and not of the wall time.
    EXPECT_LT(point.cpu_samples[i], 1.5 * point.samples[i]);
  }
  EXPECT_EQ(point.seconds(), *std::ranges::min_element(point.samples));
}

// Work is that of one run, however many a sample takes.
TEST(Batches, AnUntimedSampleIsOneRun) {
  const PointSpec spec = spec_at("chain", {{"n", 10}}, "gauss_seidel", 0.01);
  PointResult point = run_point(spec, {.timed = false});
  add_sample(point, run_point, {.timed = false});
  EXPECT_EQ(point.sample_runs, (std::vector<int>{1, 1}));
  EXPECT_EQ(point.retaken, 0);
  EXPECT_EQ(run_point(spec, {}).work, point.work);
}

// A run's parts are its time; of several runs, each part's shortest time counts.
TEST(PointRunner, ItsPartsAddUp) {
  for (const int steps : {20, 200, 2000}) {
    PointSpec spec = spec_at("drape", {{"n", 11}, {"duration", 0.2}}, "fast_projection", 0.01);
    spec.step = 0.2 / steps;
    const RunLimits limits;
    const auto done = PointRunner(spec, limits).run({}, true, diverged_strain);
    EXPECT_EQ(std::ssize(done.parts), std::min(100, steps));
    EXPECT_GT(std::ranges::min(done.parts), 0);
    const double sum = std::accumulate(done.parts.begin(), done.parts.end(), 0.0);
    EXPECT_NEAR(sum, done.seconds, 1e-9 * done.seconds);
  }
}

// Two runs of one command agree: a calibration is limited by work, not time.
TEST(PointRunner, ACalibrationIsCutOffByItsWorkAlone) {
  const PointSpec spec =
      spec_at("drape", {{"n", 7}, {"duration", 0.5}}, "vertex_block_descent", 0.01);
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

// `steps` of length h, timed in blocks; the last step takes `last` seconds, each other one 0.5.
std::vector<FrameTime> frames_of(double h, int steps, int block, double last = 0.5) {
  FrameTimes frames(h);
  for (int i = block; i <= steps; i += block)
    frames.add(block, h, i * h, i == steps ? last : 0.5 * block);
  return frames.summary();
}

TEST(FrameTimes, AddUpTheStepsThatEndInAFrame) {
  const auto rates = frames_of(1.0 / 120, 240, 1, 9);
  ASSERT_EQ(rates.size(), 3u);
  const double steps[] = {5, 4, 2};  // a frame
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rates[i].rate, 120 / steps[i]);
    EXPECT_NEAR(rates[i].median, 0.5 * steps[i], 1e-12);
    EXPECT_NEAR(rates[i].worst, 9 + 0.5 * (steps[i] - 1), 1e-12);
    EXPECT_LE(rates[i].slow, rates[i].worst);
    EXPECT_GE(rates[i].slow, rates[i].median);
  }
}

TEST(FrameTimes, AreTheSameForStepsTimedInBlocks) {
  const auto one = frames_of(0.001, 1000, 1), blocks = frames_of(0.001, 1000, 40, 20);
  ASSERT_EQ(one.size(), blocks.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(one[i].median, blocks[i].median, 1e-9);
    EXPECT_NEAR(one[i].worst, blocks[i].worst, 1e-9);
  }
}

TEST(FrameTimes, LeaveOutPartsOfAFrameAndFramesShorterThanAStep) {
  const auto coarse = frames_of(1.0 / 25, 25, 1);
  ASSERT_EQ(coarse.size(), 1u);
  EXPECT_EQ(coarse[0].rate, 24);
  EXPECT_EQ(frames_of(0.01, 5, 1, 9)[0].worst, 2) << "the fifth is in the second frame of 1.2";
  EXPECT_TRUE(frames_of(0.01, 1, 1).empty());
}

// An untimed run of 15 x 15 vertices, with errors.
PointResult compared(const char* scene, const char* solver, double step, double limit) {
  PointSpec spec = spec_at(scene, {{"n", 15}}, solver, step);
  spec.strain_limit = limit;
  const std::vector folders{source_path("results/references")};
  return run_point(spec,
                   {.references = std::make_shared<ReferenceFolder>(folders), .timed = false});
}

class DrapeErrors : public ::testing::TestWithParam<const char*> {};

// A nearly inextensible cloth falls onto a sphere with friction: with each halving of the step the
// error falls to the reference's uncertainty, and dissipated energy never comes back.
TEST_P(DrapeErrors, FallWithTheStepToTheReferencesGap) {
  if (inextensible::testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  double before = 1;
  for (const double h : {0.02, 0.01, 0.005, 0.0025, 0.00125}) {
    const PointResult point = compared("drape", GetParam(), h, 0.001);
    ASSERT_EQ(point.status, PointStatus::ok) << "h = " << h << ": " << point.detail;
    EXPECT_LE(point.measures.energy_rise, 0.002) << "h = " << h;
    const ErrorAtLevel at = error_at(point.measures, headline_error);
    EXPECT_GT(at.distance, 0);
    EXPECT_LE(at.distance, std::max(0.9 * before, sure_gaps * at.gap)) << "h = " << h;
    before = at.distance;
  }
}

INSTANTIATE_TEST_SUITE_P(ContactMethods, DrapeErrors,
                         ::testing::Values("fast_projection", "icd", "yarn_projection",
                                           "yarn_projection@bdf2", "yarn_projection@midpoint",
                                           "fast_projection_adaptive@bdf2", "gauss_seidel_colored",
                                           "jacobi", "implicit_springs"),
                         inextensible::names::contestant_name);

// Forces act in full on vertices that touch, in every stepper: halved, they led RATTLE 4 % astray.
TEST(SettlingDrape, IsRightInEveryStepper) {
  if (inextensible::testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  for (const char* contestant : {"fast_projection@midpoint", "shake", "rattle"}) {
    const PointResult point = compared("settling_drape", contestant, 1.0 / 1600, 1e-5);
    EXPECT_LT(error_at(point.measures, headline_error).distance, 0.005) << contestant;
    EXPECT_EQ(point.status, PointStatus::ok) << contestant << ": " << point.detail;
  }
}

// Edges that shake between limits of 10 % return energy step by step.
TEST(EnergyRise, FailsAShakingCloth) {
  const PointResult point = compared("drape", "fast_projection", 1.0 / 1600, 0.1);
  EXPECT_EQ(point.status, PointStatus::energy_gained) << point.detail;
  EXPECT_GT(point.measures.energy_rise, 0.05);
}

// Samples are 1, 2, 3, ... and looks take what a list says, in ms.
TEST(QuietSamples, ADisturbedLookOnEitherSideTakesItAgainUpToThreeTimes) {
  const struct {
    const char* what;
    double wait;
    std::vector<double> looks;
    int sample, dropped;
  } rows[] = {{"before", 1e-12, {1.11, 1.0, 1.0}, 2, 1},
              {"after", 1e-12, {1.0, 1.11, 1.2, 1.0, 1.0}, 3, 2},
              {"the calmest", 1e-12, {2.0, 1.5, 1.2, 1.3, 1.2, 1.2, 2.0, 3.0}, 3, 3},
              {"a wait ends with a calm look", 100, {2.0, 1.5, 1.0, 2.0, 3.0, 1.0, 1.0}, 2, 1}};
  for (const auto& [what, wait, looks, sample, dropped] : rows) {
    int samples = 0;
    std::size_t seen = 0;
    QuietProbe probe([&, &list = looks] { return 1e-3 * list.at(seen++); });
    probe.renew(1e-3);
    const auto taken = take_quietly(
        probe, [&] { return ++samples; }, [](int) { return true; }, wait);
    EXPECT_EQ(taken, std::pair(sample, dropped)) << what;
    EXPECT_EQ(seen, looks.size()) << what;
  }
}

TEST(QuietSamples, TheUsualTimeIsLearnedAgain) {
  double now = 1;
  QuietProbe probe([&now] { return now; });
  probe.look();
  now = 1.2;
  EXPECT_TRUE(probe.disturbed(probe.look()));
  probe.renew(1.2);
  EXPECT_FALSE(probe.disturbed(probe.look())) << "nothing was renewed before";
  probe.renew(1.0);
  EXPECT_TRUE(probe.disturbed(probe.look()));
  probe.renew(1.2);
  EXPECT_TRUE(probe.disturbed(probe.look())) << "the one before the last counts, too";
  probe.renew(1.2);
  EXPECT_FALSE(probe.disturbed(probe.look()));
}

// Others leave the core alone every tenth time only.
TEST(NoiseProbe, SeesThatOthersTakeTheProcessor) {
  bool shared = false;
  int turn = 0;
  NoiseProbe noise_probe([&] { return shared && ++turn % 10 > 0 ? 5e-3 : 1e-3; });
  EXPECT_EQ(noise_probe.spread(), 0);
  EXPECT_FALSE(noise_probe.noisy());
  noise_probe.sample();
  noise_probe.sample();
  EXPECT_FALSE(noise_probe.noisy());
  shared = true;
  noise_probe.sample();
  const json seen = noise_probe.to_json();
  EXPECT_EQ(seen.at("seconds").size(), 3u);
  EXPECT_EQ(seen.at("noisy"), true) << "spread " << noise_probe.spread();
}

}  // namespace
}  // namespace harness
