// Ensembles: means and deviations against figures by hand, what a run's shape error is, and which
// runs have lost their motion.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/base/errors.h"
#include "harness/judge/drive.h"
#include "harness/judge/judge.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference_routes.h"
#include "solvers/registry.h"
#include "support/scenes.h"

namespace harness {
namespace {

using inextensible::State;
using inextensible::Velocities;
using testing::build;

const std::vector<double> two_times{0.04, 0.08};

// Three runs whose figures are 1, 2, 6 (mean 3, deviation sqrt(7)) at first, and 0, 0, 3 then.
TEST(Ensemble, HasTheMeansAndDeviationsOfItsRuns) {
  const Ensemble e = ensemble_of(
      {{{1, 1, 1, 1}, {0, 0, 0, 0}}, {{2, 2, 2, 2}, {0, 0, 0, 0}}, {{6, 6, 6, 6}, {3, 3, 3, 3}}});
  EXPECT_EQ(e.runs, 3);
  const double mean[] = {3, 1}, deviation[] = {std::sqrt(7), std::sqrt(3)};
  // The runs' averages over both times: 0.5, 1, 4.5; mean 2, squares 2.25 + 1 + 6.25.
  const double kinetic_deviation[] = {std::sqrt(7), std::sqrt(9.5 / 2)};
  for (std::size_t i = 0; i < 2; ++i) {
    for (const auto& [name, member] : shape_statistic_infos) {
      EXPECT_NEAR(e.mean[i].*member, mean[i], 1e-15) << name;
      EXPECT_NEAR(e.deviation[i].*member, deviation[i], 1e-15) << name;
    }
    EXPECT_NEAR(e.kinetic_deviation[i], kinetic_deviation[i], 1e-15);
  }
}

Measures measured(const Ensemble& ensemble, const std::vector<double>& times,
                  const ShapeSeries& run) {
  Measures measures;
  measure_shape(ensemble, times, run, measures);
  return measures;
}

TEST(ShapeError, IsTheLargestDeviationBeyondThreeStandardDeviations) {
  Ensemble e;
  e.mean = {{0, 1, 0, 0}, {0, 1, 0, 0}};
  e.deviation = {{0.1, 0.1, 0.1, 0.1}, {0.2, 0, 0.01, 0.2}};
  e.kinetic_deviation = {0.1, 0.05};
  const struct {
    ShapeSeries run;
    double error;
    std::string statistic;
    double kinetic_ratio, kinetic_spread;
  } cases[] = {{{{0.3, 0.7, -0.3, 0}, {-0.6, 1, 0.03, 0}}, 0, "", 0.85, 0.15},
               {{{0.5, 1, 0, 0}, {0, 1, -0.33, 0.7}}, 0.3, "corner_height", 1, 0.15},
               {{{0.5, 0.6, 0, 0}}, 0.2, "potential_energy", 0.6, 0.3},  // of a shorter run
               {{{0, 0.6, 0, 0}, {0, 0.8, 0, 0}}, 0.2, "kinetic_energy", 0.7, 0.15},
               {{{0, 1, 0, 0}}, 0, "", 1, 0.3}};
  for (const auto& [run, error, statistic, ratio, spread] : cases) {
    const Measures found = measured(e, two_times, run);
    EXPECT_NEAR(found.shape, error, 1e-15);
    if (found.shape > 1e-15) {
      EXPECT_EQ(found.shape_statistic, statistic);
    }
    EXPECT_NEAR(found.kinetic_ratio, ratio, 1e-15);
    EXPECT_NEAR(found.kinetic_spread, spread, 1e-15);
  }
  EXPECT_EQ(measured(e, two_times, cases[1].run).shape_time, 0.08);
  EXPECT_TRUE(std::isnan(measured(e, two_times, {}).shape));
  EXPECT_TRUE(std::isnan(measured(e, two_times, {{unknown, 1, 0, 0}}).shape));
}

TEST(ShapeError, MotionIsLostFarFromTheEnsemblesAndBeyondItsOwnSpread) {
  for (const auto& [ratio, spread] :
       {std::pair(0.61, 0.0), {1.24, 0}, {0.59, 0.45}, {unknown, unknown}})
    EXPECT_FALSE(kinetic_energy_lost(ratio, spread)) << ratio << " +- " << spread;
  EXPECT_TRUE(kinetic_energy_lost(0.59, 0.1) && kinetic_energy_lost(1.26, 0.1));
}

// A free fall: K = m g^2 t^2 / 2. Velocities of the middle of a step give the mean of K at both
// middles, which is exact but for m g^2 h^2 / 8; those of its end are exact.
TEST(ShapeRecord, PutsKineticEnergiesToTheTimesOfPositions) {
  const Scene scene = build("patch", {{"n", 3}});
  const double h = 0.02, fall = 9.81, weight = energy_scale(scene) / scene.size;
  for (const bool whole : {true, false}) {
    ShapeRecord record(scene, two_times, whole ? Velocities::whole_step : Velocities::half_step);
    State state = scene.start;
    for (int k = 1; k <= 4; ++k) {
      state.time = k * h;
      state.v.setZero();
      state.v.row(1).setConstant(-fall * (state.time - (whole ? 0 : h / 2)));
      if (k % 2 == 0) record.sample(state.x);
      record.step(state, h);
    }
    const ShapeSeries found = record.finish();
    ASSERT_EQ(found.size(), 2u);
    const auto kinetic = [&](double squared_time) {
      return fall * squared_time / 2 * weight / energy_scale(scene);
    };
    const double middles = (std::pow(0.03, 2) + std::pow(0.05, 2)) / 2;
    EXPECT_NEAR(found[0].kinetic_energy, kinetic(whole ? 0.04 * 0.04 : middles), 1e-12) << whole;
    // After the last step no velocity follows: it is not raised beyond its own.
    EXPECT_NEAR(found[1].kinetic_energy, kinetic(std::pow(whole ? 0.08 : 0.07, 2)), 1e-12) << whole;
  }
}

TEST(ShapeStatistics, OfAFlatSquareAreItsHeightAndItsArea) {
  const Scene scene = build("drape", {{"n", 9}, {"subdivisions", 0}});
  const ShapeStatistics shape = shape_statistics(scene, scene.start.x);
  EXPECT_NEAR(shape.corner_height, 0.251, 1e-12);
  EXPECT_NEAR(shape.potential_energy, 0.251, 1e-12);
  EXPECT_NEAR(shape.shadow, 1, 0.01);  // pixels
  inextensible::Positions folded = scene.start.x;
  folded.row(0) = folded.row(0).cwiseAbs();
  EXPECT_NEAR(shape_statistics(scene, folded).shadow, 0.5, 0.01);
}

void say_nothing(const std::string& /*line*/) {}

// A small drape and its ensemble, made once.
struct SmallDrape {
  SceneParameters parameters = testing::parameters("drape", {{"n", 7}, {"duration", 0.6}});
  Scene scene = find_scene("drape")->build(parameters);
  std::vector<double> times = sample_times(scene.duration);
  EnsemblePlan plan{.step = sample_interval / 20};
  RouteRuns runs{say_nothing};
  Ensemble ensemble = compute_ensemble(scene, times, plan, runs);
};

class DrapeEnsemble : public ::testing::Test {
 protected:
  static const SmallDrape& drape() {
    static const SmallDrape made;
    return made;
  }

  static std::shared_ptr<Reference> reference() {
    auto r = std::make_shared<Reference>();
    r->scene = "drape";
    r->parameters = drape().parameters;
    r->times = drape().times;
    r->gap.assign(r->times.size(), 1);
    r->gap_max = r->gap;
    r->ensemble = drape().ensemble;
    return r;
  }

  // A run of fast projection, judged; its problem may be another than the judge's.
  static Measures judged(const Scene& moved_by, double h) {
    const auto& backend = *inextensible::find_backend("fast_projection");
    Judge judge(drape().scene, {.reference = reference(), .velocities = backend.velocities});
    const auto stepper =
        inextensible::make_stepper("fast_projection", moved_by.problem, {1e-4, 1, {}});
    State state = start_of(moved_by, backend, h);
    judge.before(state, h);
    const auto look = [&](const State& now, const DriveState& /*driven*/) {
      judge.after(now.x, now, h);
      judge.before(now, h);
      return true;
    };
    drive(*stepper, state, {h, std::lround(drape().scene.duration / h)}, look);
    EXPECT_NEAR(state.time, drape().scene.duration, 1e-9);
    return judge.finish();
  }
};

TEST_F(DrapeEnsemble, IsOfBothRoutesFromMovedStarts) {
  const Ensemble& e = drape().ensemble;
  ASSERT_TRUE(e.known()) << e.unknown_because;
  EXPECT_GE(e.runs, 12);
  ASSERT_EQ(e.methods.size(), 2u);
  EXPECT_NE(e.methods[0].substr(0, 4), e.methods[1].substr(0, 4));
  ASSERT_EQ(e.mean.size(), drape().times.size());
  // It falls freely at first: K = g t^2 / 2 over the size, by routes of first order in the step.
  EXPECT_NEAR(e.mean[0].kinetic_energy, 9.81 * 0.04 * 0.04 / 2, 1e-3);
  EXPECT_NEAR(e.mean[0].kinetic_energy + e.mean[0].potential_energy, 0.251, 1e-3);
}

// The largest of n deviations of a sample is at most (n - 1) / sqrt(n) standard deviations: of 16
// runs 3.75, so one of them may have an error, and the others none.
TEST_F(DrapeEnsemble, ErrorOfItsOwnRunsIsNextToNothing) {
  double sum = 0;
  for (const auto& [name, run] : drape().runs.known()) {
    const Measures found = measured(drape().ensemble, drape().times, run.shape);
    EXPECT_FALSE(kinetic_energy_lost(found.kinetic_ratio, found.kinetic_spread)) << name;
    sum += found.shape;
  }
  EXPECT_LT(sum / static_cast<double>(drape().runs.known().size()), 0.002);
}

TEST_F(DrapeEnsemble, ErrorIsSmallOfAnOrdinaryRunAndLargeUnderAnotherGravity) {
  const Measures good = judged(drape().scene, 0.001);
  EXPECT_EQ(good.shape_unknown_because, "");
  EXPECT_NEAR(good.kinetic_ratio, 1, 0.15);
  EXPECT_FALSE(kinetic_energy_lost(good.kinetic_ratio, good.kinetic_spread));
  auto heavier = drape().parameters;
  heavier["gravity"] *= 1.2;
  const Measures wrong = judged(build("drape", heavier), 0.001);
  EXPECT_GT(wrong.shape, 0.02);
  EXPECT_GT(wrong.shape, 2 * good.shape);
  EXPECT_NE(wrong.shape_statistic, "");
  EXPECT_GT(wrong.shape_time, 0);
}

TEST_F(DrapeEnsemble, ErrorOfARunThatHangsIsLargeAndItsMotionLost) {
  const auto hang = [&](double until) {
    Judge judge(drape().scene, {.reference = reference()});
    State state = drape().scene.start;
    for (int k = 1; 0.04 * k <= until * (1 + 1e-9); ++k) {
      judge.before(state, 0.04);
      state.time = 0.04 * k;
      judge.after(state.x, state, 0.04);
    }
    return judge.finish();
  };
  const Measures frozen = hang(0.6);
  EXPECT_EQ(frozen.kinetic_ratio, 0);
  EXPECT_TRUE(kinetic_energy_lost(frozen.kinetic_ratio, frozen.kinetic_spread));
  EXPECT_GT(frozen.shape, 0.2);
  const Measures cut = hang(0.2);
  EXPECT_TRUE(std::isnan(cut.shape));
  EXPECT_TRUE(std::isnan(cut.kinetic_ratio));
  EXPECT_EQ(cut.shape_unknown_because, "the run ended after 5 of 15 sample times");
}

TEST_F(DrapeEnsemble, LeavesOutRunsThatFailAndNeedsEight) {
  for (const int fail : {8, 9}) {
    RouteRuns runs(say_nothing);
    int asked = 0;
    for (const auto& [name, run] : drape().runs.known())
      runs.run(name, [&, made = run] { return asked++ < fail ? RouteRun() : made; });
    const Ensemble e = compute_ensemble(drape().scene, drape().times, drape().plan, runs);
    EXPECT_EQ(e.runs, 16 - fail);
    EXPECT_EQ(e.known(), fail == 8);
    EXPECT_EQ(e.unknown_because.empty(), fail == 8);
  }
}

TEST_F(DrapeEnsemble, LeavesOutRunsThatGainEnergy) {
  Scene strict = drape().scene;
  strict.energy_bound = -1;  // weight times size: nothing loses that much
  RouteRuns runs(say_nothing);
  const Ensemble e = compute_ensemble(strict, {0.04}, drape().plan, runs);
  EXPECT_FALSE(e.known());
  EXPECT_EQ(e.runs, 0);
}

TEST_F(DrapeEnsemble, SurvivesItsFileAndIsAddedToOthers) {
  const auto r = reference();
  r->ensemble = {};
  const nlohmann::json bare = to_json(*r);
  EXPECT_FALSE(reference_of(bare, "bare").ensemble.known());
  nlohmann::json added = with_ensemble(bare, drape().ensemble);
  const Ensemble again = reference_of(nlohmann::json::parse(added.dump()), "added").ensemble;
  EXPECT_EQ(with_ensemble(bare, again), added);
  // All else is as it was, and as a reference with that ensemble is written.
  r->ensemble = drape().ensemble;
  EXPECT_EQ(added, to_json(*r));
  added["ensemble"]["mean"].erase(0);
  EXPECT_THROW(static_cast<void>(reference_of(added, "short")), UsageError);
}

}  // namespace
}  // namespace harness
