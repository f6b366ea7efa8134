// Ensembles: means and deviations against figures by hand, what a run's shape error is, and which
// runs have lost their motion.
#include "harness/judge/ensemble.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/judge/drive.h"
#include "harness/judge/ensemble_runs.h"
#include "harness/judge/judge.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference_file.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::State;
using inextensible::Velocities;

const std::vector<double> two_times{0.04, 0.08};

// Three runs whose figures are 1, 2, 6 (mean 3, deviation sqrt(7)) at first, and 0, 0, 3 then.
std::vector<ShapeSeries> three_runs() {
  return {{{1, 1, 1, 1}, {0, 0, 0, 0}}, {{2, 2, 2, 2}, {0, 0, 0, 0}}, {{6, 6, 6, 6}, {3, 3, 3, 3}}};
}

TEST(Ensemble, HasTheMeansAndDeviationsOfItsRuns) {
  const Ensemble e = ensemble_of(three_runs());
  EXPECT_EQ(e.runs, 3);
  EXPECT_TRUE(e.known());
  for (const auto& [name, member] : shape_statistic_infos) {
    EXPECT_NEAR(e.mean[0].*member, 3, 1e-15) << name;
    EXPECT_NEAR(e.deviation[0].*member, std::sqrt(7), 1e-15) << name;
    EXPECT_NEAR(e.mean[1].*member, 1, 1e-15) << name;
    EXPECT_NEAR(e.deviation[1].*member, std::sqrt(3), 1e-15) << name;
  }
  // The runs' averages over both times: 0.5, 1, 4.5; mean 2, squares 2.25 + 1 + 6.25.
  EXPECT_NEAR(e.kinetic_deviation[0], std::sqrt(7), 1e-15);
  EXPECT_NEAR(e.kinetic_deviation[1], std::sqrt(9.5 / 2), 1e-15);
}

TEST(ShapeError, IsTheLargestDeviationBeyondThreeStandardDeviations) {
  Ensemble e;
  e.mean = {{0, 1, 0, 0}, {0, 1, 0, 0}};
  e.deviation = {{0.1, 0.1, 0.1, 0.1}, {0.2, 0, 0.01, 0.2}};
  e.kinetic_deviation = {0.1, 0.05};
  const ShapeError within = shape_error(e, two_times, {{0.3, 0.7, -0.3, 0}, {-0.6, 1, 0.03, 0}});
  EXPECT_NEAR(within.error, 0, 1e-15);
  const ShapeError found = shape_error(e, two_times, {{0.5, 1, 0, 0}, {0, 1, -0.33, 0.7}});
  EXPECT_NEAR(found.error, 0.3, 1e-15);
  EXPECT_STREQ(found.statistic, "corner_height");
  EXPECT_EQ(found.time, 0.08);
  const ShapeError of_one = shape_error(e, two_times, {{0.5, 0.6, 0, 0}});
  EXPECT_NEAR(of_one.error, 0.2, 1e-15) << "of a shorter run";
  EXPECT_STREQ(of_one.statistic, "potential_energy");
  EXPECT_NEAR(of_one.kinetic_ratio, 0.6, 1e-15);
  EXPECT_NEAR(of_one.kinetic_spread, 0.3, 1e-15);
  const ShapeError both = shape_error(e, two_times, {{0, 0.6, 0, 0}, {0, 0.8, 0, 0}});
  EXPECT_NEAR(both.kinetic_ratio, 0.7, 1e-15);
  EXPECT_NEAR(both.kinetic_spread, 0.15, 1e-15);
  EXPECT_TRUE(std::isnan(shape_error(e, two_times, {}).error));
  EXPECT_TRUE(std::isnan(shape_error(e, two_times, {{unknown, 1, 0, 0}}).error));
  EXPECT_EQ(shape_error(e, two_times, {{0, 1, 0, 0}}).error, 0);
  EXPECT_STREQ(shape_error(e, two_times, {{0, 1, 0, 0}}).statistic, "");
}

TEST(ShapeError, MotionIsLostFarFromTheEnsemblesAndBeyondItsOwnSpread) {
  EXPECT_FALSE(kinetic_energy_lost(0.61, 0));
  EXPECT_FALSE(kinetic_energy_lost(1.24, 0));
  EXPECT_TRUE(kinetic_energy_lost(0.59, 0.1));
  EXPECT_TRUE(kinetic_energy_lost(1.26, 0.1));
  EXPECT_FALSE(kinetic_energy_lost(0.59, 0.45)) << "runs of the ensemble are as far apart";
  EXPECT_FALSE(kinetic_energy_lost(unknown, unknown)) << "without an ensemble nothing is lost";
}

// A free fall: K = m g^2 t^2 / 2. Velocities of the middle of a step give the mean of K at both
// middles, which is exact but for m g^2 h^2 / 8; those of its end are exact.
TEST(ShapeRecord, PutsKineticEnergiesToTheTimesOfPositions) {
  const auto type = find_scene("patch");
  const Scene scene = type->build(complete_parameters(*type, {{"n", 3}}));
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
  const auto found_type = find_scene("drape");
  const SceneType& type = *found_type;
  const auto parameters = complete_parameters(type, {{"n", 9}, {"subdivisions", 0}});
  const Scene scene = type.build(parameters);
  const ShapeStatistics shape = shape_statistics(scene, scene.start.x);
  EXPECT_NEAR(shape.corner_height, 0.251, 1e-12);
  EXPECT_NEAR(shape.potential_energy, 0.251, 1e-12);
  EXPECT_NEAR(shape.shadow, 1, 0.01);  // pixels
  inextensible::Positions folded = scene.start.x;
  folded.row(0) = folded.row(0).cwiseAbs();
  EXPECT_NEAR(shape_statistics(scene, folded).shadow, 0.5, 0.01);
}

// A small drape and its ensemble, made once.
struct SmallDrape {
  SceneParameters parameters;
  Scene scene;
  std::vector<double> times;
  EnsemblePlan plan;
  std::map<std::string, RouteRun> runs;
  Ensemble ensemble;
};

Tell silence() {
  return [](const std::string&) {};
}

const SmallDrape& small_drape() {
  static const SmallDrape drape = [] {
    SmallDrape made;
    const auto type = find_scene("drape");
    made.parameters = complete_parameters(*type, {{"n", 7}, {"duration", 0.6}});
    made.scene = type->build(made.parameters);
    made.times = sample_times(made.scene.duration);
    made.plan.step = sample_interval / 20;
    made.ensemble = compute_ensemble(
        made.scene, made.times, made.plan, silence(),
        [&made](const auto& name, const auto& compute) -> const RouteRun& {
          const auto known = made.runs.find(name);
          return known != made.runs.end() ? known->second
                                          : made.runs.emplace(name, compute()).first->second;
        });
    return made;
  }();
  return drape;
}

std::shared_ptr<Reference> reference_of(const SmallDrape& drape) {
  auto r = std::make_shared<Reference>();
  r->scene = "drape";
  r->parameters = drape.parameters;
  r->times = drape.times;
  r->gap.assign(r->times.size(), 1);
  r->gap_max = r->gap;
  r->ensemble = drape.ensemble;
  return r;
}

// A run of fast projection, judged; its problem may be another than the judge's.
Measures judged(const SmallDrape& drape, const Scene& moved_by, double h) {
  Judge::Options options;
  options.reference = reference_of(drape);
  options.velocities = inextensible::find_backend("fast_projection")->velocities;
  Judge judge(drape.scene, options);
  const auto stepper =
      inextensible::make_stepper("fast_projection", moved_by.problem, {1e-4, 1, {}});
  State state = start_of(moved_by, *inextensible::find_backend("fast_projection"), h);
  judge.before(state, h);
  const auto look = [&](const State& now, const DriveState& /*driven*/) {
    judge.after(now.x, now, h);
    judge.before(now, h);
    return true;
  };
  drive(*stepper, state, {h, std::lround(drape.scene.duration / h)}, look);
  EXPECT_NEAR(state.time, drape.scene.duration, 1e-9);
  return judge.finish();
}

TEST(Ensemble, OfADrapeIsOfBothRoutesFromMovedStarts) {
  const SmallDrape& drape = small_drape();
  const Ensemble& e = drape.ensemble;
  ASSERT_TRUE(e.known()) << e.unknown_because;
  EXPECT_GE(e.runs, 12);
  ASSERT_EQ(e.methods.size(), 2u);
  EXPECT_NE(e.methods[0].substr(0, 4), e.methods[1].substr(0, 4));
  ASSERT_EQ(e.mean.size(), drape.times.size());
  // It falls freely at first: K = g t^2 / 2 over the size, by routes of first order in the step.
  EXPECT_NEAR(e.mean[0].kinetic_energy, 9.81 * 0.04 * 0.04 / 2, 1e-3);
  EXPECT_NEAR(e.mean[0].kinetic_energy + e.mean[0].potential_energy, 0.251, 1e-3);
}

// The largest of n deviations of a sample is at most (n - 1) / sqrt(n) standard deviations: of 16
// runs 3.75, so one of them may have an error, and the others none.
TEST(ShapeError, OfARunOfTheEnsembleIsNextToNothing) {
  const SmallDrape& drape = small_drape();
  double sum = 0;
  for (const auto& [name, run] : drape.runs) {
    const ShapeError found = shape_error(drape.ensemble, drape.times, run.shape);
    EXPECT_FALSE(kinetic_energy_lost(found.kinetic_ratio, found.kinetic_spread)) << name;
    sum += found.error;
  }
  EXPECT_LT(sum / static_cast<double>(drape.runs.size()), 0.002);
}

TEST(ShapeError, IsSmallOfAnOrdinaryRunAndLargeUnderAnotherGravity) {
  const SmallDrape& drape = small_drape();
  const Measures good = judged(drape, drape.scene, 0.001);
  EXPECT_EQ(good.shape_unknown_because, "");
  EXPECT_NEAR(good.kinetic_ratio, 1, 0.15);
  EXPECT_FALSE(kinetic_energy_lost(good.kinetic_ratio, good.kinetic_spread));
  const auto type = find_scene("drape");
  auto heavier = drape.parameters;
  heavier["gravity"] *= 1.2;
  const Measures wrong = judged(drape, type->build(heavier), 0.001);
  EXPECT_GT(wrong.shape, 0.02);
  EXPECT_GT(wrong.shape, 2 * good.shape);
  EXPECT_NE(wrong.shape_statistic, "");
  EXPECT_GT(wrong.shape_time, 0);
}

TEST(ShapeError, OfARunThatHangsIsLargeAndItsMotionLost) {
  const SmallDrape& drape = small_drape();
  Judge::Options options;
  options.reference = reference_of(drape);
  const auto hang = [&](double until) {
    Judge judge(drape.scene, options);
    State state = drape.scene.start;
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

TEST(ShapeError, SaysWhyThereIsNone) {
  const auto why = [](const Scene& scene, std::shared_ptr<const Reference> reference) {
    Judge::Options options;
    options.reference = std::move(reference);
    return Judge(scene, options).finish().shape_unknown_because;
  };
  const SmallDrape& drape = small_drape();
  EXPECT_EQ(why(drape.scene, nullptr), "no reference of this scene, size and parameters");
  const auto reference = reference_of(drape);
  reference->ensemble = {};
  EXPECT_EQ(why(drape.scene, reference), "the reference has no ensemble");
  reference->ensemble.unknown_because = "only 7 of 16 runs";
  EXPECT_EQ(why(drape.scene, reference), "no ensemble: only 7 of 16 runs");
  const auto chain = find_scene("chain");
  EXPECT_EQ(why(chain->build(complete_parameters(*chain, {{"n", 4}})), nullptr),
            "the scene is no cloth");
}

TEST(Ensemble, LeavesOutRunsThatFailAndNeedsEight) {
  const SmallDrape& drape = small_drape();
  for (const int fail : {3, 8, 9}) {
    int asked = 0;
    RouteRun failed;
    const Ensemble e = compute_ensemble(drape.scene, drape.times, drape.plan, silence(),
                                        [&](const auto& name, const auto&) -> const RouteRun& {
                                          return asked++ < fail ? failed : drape.runs.at(name);
                                        });
    EXPECT_EQ(e.runs, 16 - fail);
    EXPECT_EQ(e.known(), fail <= 8);
    EXPECT_EQ(
        e.unknown_because,
        fail <= 8
            ? ""
            : "only 7 of 16 reference runs came to the end without fault, an ensemble needs 8");
  }
}

TEST(Ensemble, LeavesOutRunsThatGainEnergy) {
  const SmallDrape& drape = small_drape();
  Scene strict = drape.scene;
  strict.energy_bound = -1;  // weight times size: nothing loses that much
  std::map<std::string, RouteRun> runs;
  int told = 0;
  const Ensemble e = compute_ensemble(
      strict, {0.04}, drape.plan,
      [&told](const std::string& line) { told += line.find("left out") != std::string::npos; },
      [&runs](const std::string& name, const auto& compute) -> const RouteRun& {
        return runs.emplace(name, compute()).first->second;
      });
  EXPECT_FALSE(e.known());
  EXPECT_EQ(e.runs, 0);
  EXPECT_EQ(told, 16);
}

// A computation that was stopped goes on with the runs that were not done, to the same ensemble.
TEST(Ensemble, IsMadeInPieces) {
  const SmallDrape& drape = small_drape();
  const std::string out = ::testing::TempDir() + "ensemble_pieces.json";
  std::filesystem::remove(out + ".journal");
  const auto compute = [&](int most, int* made) {
    ReferencePieces pieces(out, {{"build", 1}});
    return compute_ensemble(drape.scene, drape.times, drape.plan, silence(),
                            [&](const std::string& name, const auto& run) -> const RouteRun& {
                              return pieces.run(name, [&] {
                                if (++*made > most) throw Interrupted();
                                return run();
                              });
                            });
  };
  int first = 0, rest = 0;
  EXPECT_THROW(static_cast<void>(compute(5, &first)), Interrupted);
  const Ensemble again = compute(100, &rest);
  EXPECT_EQ(rest, 11);
  EXPECT_EQ(to_json(again.mean), to_json(drape.ensemble.mean));
  EXPECT_EQ(to_json(again.deviation), to_json(drape.ensemble.deviation));
  EXPECT_EQ(again.kinetic_deviation, drape.ensemble.kinetic_deviation);
  std::filesystem::remove(out + ".journal");
}

TEST(Ensemble, SurvivesItsFileAndIsAddedToOthers) {
  const SmallDrape& drape = small_drape();
  const auto reference = reference_of(drape);
  reference->ensemble = {};
  nlohmann::json bare = to_json(*reference);
  EXPECT_FALSE(bare.contains("ensemble"));
  const std::string path = ::testing::TempDir() + "with_ensemble.json";
  std::ofstream(path) << bare;
  EXPECT_FALSE(read_reference(path).ensemble.known());
  nlohmann::json added = with_ensemble(bare, drape.ensemble);
  std::ofstream(path) << added;
  const Ensemble again = read_reference(path).ensemble;
  EXPECT_EQ(again.methods, drape.ensemble.methods);
  EXPECT_EQ(again.runs, drape.ensemble.runs);
  EXPECT_EQ(again.moved, drape.ensemble.moved);
  EXPECT_EQ(to_json(again.mean), to_json(drape.ensemble.mean));
  EXPECT_EQ(to_json(again.deviation), to_json(drape.ensemble.deviation));
  EXPECT_EQ(again.kinetic_deviation, drape.ensemble.kinetic_deviation);
  // All else is as it was, and as a reference with that ensemble is written.
  reference->ensemble = drape.ensemble;
  EXPECT_EQ(added, to_json(*reference));
  added["ensemble"]["mean"].erase(0);
  std::ofstream(path) << added;
  EXPECT_THROW(static_cast<void>(read_reference(path)), UsageError);
}

}  // namespace
}  // namespace harness
