// The search for settings, with objectives whose optimum is known, and with a fake clock.
#include "harness/run/tune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "harness/base/errors.h"

namespace harness {
namespace {

std::vector<TunedNumber> numbers() {
  return {{"relaxation", 1, {0.5, 1.95, 2}, false},
          {"tolerance", 0.1, {1e-4, 1}, false},
          {"sweeps", 0, {0, 120}, true}};
}

// A bowl in relaxation, log tolerance and log count; lowest, 1 s, at 1.7, 0.01 and 30.
double bowl(const Values& v) {
  return 1 + 2 * std::pow(v[0] - 1.7, 2) + 0.3 * std::pow(std::log10(v[1]) + 2, 2) +
         0.2 * std::pow(std::log((1 + v[2]) / 31), 2);
}

TEST(TuneSearch, FindsTheLowestPointOfASmoothFunction) {
  const auto seconds = [](const Values& v, double) { return std::optional(bowl(v)); };
  const TuneOutcome found = tune_values(numbers(), seconds, {.budget = 60});
  EXPECT_LT(bowl(found.values), 1.06);  // what is within 5 % is not worth a change
  EXPECT_NEAR(found.gain, bowl({1, 0.1, 0}) / bowl(found.values), 1e-12);
  EXPECT_LE(found.evaluations, 60);
  EXPECT_EQ(found.values[2], std::round(found.values[2]));
  EXPECT_EQ(tune_values(numbers(), seconds, {.budget = 60}).values, found.values);
}

TEST(TuneSearch, FindsItBesideARegionThatFails) {
  const auto seconds = [](const Values& v, double) -> std::optional<double> {
    if (v[0] > 1.75 || v[2] > 40) return {};
    return bowl(v);
  };
  const TuneOutcome found = tune_values(numbers(), seconds, {.budget = 60});
  EXPECT_LT(bowl(found.values), 1.1);
  EXPECT_TRUE(seconds(found.values, 1e300));
}

TEST(TuneSearch, OneNumberIsFoundWithinAFewPercentOfItsRange) {
  for (const double best : {0.6, 1.1, 1.5, 1.9}) {
    const auto seconds = [best](const Values& v, double) {
      return std::optional(0.05 + std::pow(v[0] - best, 2));
    };
    const TuneOutcome found = tune_values({numbers()[0]}, seconds, {.budget = 24});
    EXPECT_NEAR(found.values[0], best, 0.06) << best;
  }
}

// A narrow valley that runs across both ranges, as that of relaxation and target does: along one
// setting alone there is next to nothing to gain. What is found must leave at most 10 % to gain.
TEST(TuneSearch, FindsTheLowestPointOfAValleyAcrossTwoSettings) {
  int within_10_percent = 0;
  constexpr int valleys = 200;
  for (std::uint64_t seed = 1; seed <= valleys; ++seed) {
    std::mt19937_64 random(seed);
    const auto draw = [&random](double least, double most) {
      return std::uniform_real_distribution<double>(least, most)(random);
    };
    const double u = draw(0.1, 0.9), v = draw(0.1, 0.9), angle = draw(0, 3.14159);
    const std::vector<TunedNumber> two{{"relaxation", 1, {0.5, 1.95}, false},
                                       {"target", 0, {0, 0.9}, false}};
    const auto seconds = [&](const Values& values, double) {
      const double x = position_of(two[0], values[0]) - u, y = position_of(two[1], values[1]) - v;
      const double along = std::cos(angle) * x + std::sin(angle) * y;
      const double across = std::cos(angle) * y - std::sin(angle) * x;
      return std::optional(1 + 2 * along * along + 20 * across * across);
    };
    if (*seconds(tune_values(two, seconds).values, 0) < 1.1) ++within_10_percent;
  }
  EXPECT_GE(within_10_percent, valleys * 90 / 100);
}

TEST(TuneSearch, ManySettingsStayWithinTheBudget) {
  const std::vector<TunedNumber> many(20, {"relaxation", 1, {0.5, 1.95}, false});
  const auto seconds = [](const Values& v, double) { return std::optional(1 + v[0]); };
  EXPECT_LE(tune_values(many, seconds).evaluations, TuneRules{}.budget);
}

TEST(TuneSearch, KeepsWhatIsAsGoodAsAnything) {
  const auto flat = [](const Values& v, double) {
    return std::optional(1 + 0.02 * std::sin(50 * v[0] + 9 * v[1]));  // 4 %: below what counts
  };
  const TuneOutcome found = tune_values(numbers(), flat);
  EXPECT_EQ(found.values, (Values{1, 0.1, 0}));
  EXPECT_EQ(found.gain, 1);
  int calls = 0;
  const auto fails = [&calls](const Values&, double) {
    ++calls;
    return std::optional<double>();
  };
  EXPECT_EQ(tune_values(numbers(), fails).values, (Values{1, 0.1, 0}));
  EXPECT_EQ(calls, 1) << "what fails as it is has nothing to be compared with";
}

TEST(TuneSearch, NeverReturnsAnythingWorseThanTheDefaultWhateverTheNoise) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, 0.02);
    const double slope = std::uniform_real_distribution<double>(-1, 1)(random);
    const auto truth = [slope](const Values& v) { return 2 + slope * (v[0] - 1); };
    int calls = 0;
    const auto seconds = [&](const Values& v, double) {
      ++calls;
      return std::optional(truth(v) * std::exp(noise(random)));
    };
    const TuneOutcome found = tune_values(numbers(), seconds, {.budget = 20});
    EXPECT_LE(calls, 20);
    EXPECT_EQ(calls, found.evaluations);
    EXPECT_LE(truth(found.values), truth({1, 0.1, 0}));
  }
}

TEST(TuneSearch, ValuesStayInTheirRangeAndComeBackFromTheirPosition) {
  for (const TunedNumber& n : numbers()) {
    for (double at = 0; at <= 1; at += 0.01) {
      const double value = value_at(n, at);
      EXPECT_GE(value, n.range.least);
      EXPECT_LE(value, n.range.largest);
      EXPECT_NEAR(value_at(n, position_of(n, value)), value, 2e-3 * value) << n.name;
    }
    EXPECT_EQ(position_of(n, n.range.least), 0);
    EXPECT_EQ(position_of(n, n.range.largest), 1);
  }
  EXPECT_NEAR(value_at(numbers()[1], 0.5), 0.01, 1e-12) << "logarithmic";
}

// Colored Gauss-Seidel under a fake clock: its time is lowest at a relaxation of 1.7 and a step of
// 1/200 s; above `fails_above` it misses the tightest limit.
SweepRunners fake(double fails_above, std::vector<PointSpec>* specs = nullptr) {
  SweepRunners runners;
  runners.run = [=](const PointSpec& spec, const RunLimits& limits, std::optional<double>) {
    if (specs) specs->push_back(spec);
    PointResult point;
    point.spec = spec;
    const auto given = spec.settings.find("relaxation");
    const double relaxation = given == spec.settings.end() ? 1.0 : std::get<double>(given->second);
    const double off = std::log2(spec.step * 200);
    const double seconds = (0.1 + std::pow(relaxation - 1.7, 2)) * (1 + off * off);
    const bool fails = relaxation > fails_above && spec.strain_limit < 0.005;
    point.status = fails                       ? PointStatus::strain_missed
                   : seconds > limits.hopeless ? PointStatus::timeout
                                               : PointStatus::ok;
    if (point.ok()) point.samples = {seconds};
    return point;
  };
  runners.repeat = [](PointResult& point, const RunLimits&) {
    point.samples.push_back(point.samples.front());
  };
  return runners;
}

TuneOptions thorough() { return {.rules = {.budget = 60}, .trials_each = 30, .longest_run = 10}; }

double relaxation_of(const TunedPlace& place) {
  const auto found = place.settings.find("relaxation");
  return found == place.settings.end() ? 1.0 : std::get<double>(found->second);
}

SweepSpec chain() { return tuning_scenes().front(); }

TEST(Tune, FindsASettingAndSaysWhatItGains) {
  std::vector<PointSpec> specs;
  const TunedEntry entry =
      tune_solver("gauss_seidel_colored", chain(), thorough(), fake(10, &specs));
  EXPECT_EQ(entry.kind, "chain");
  ASSERT_EQ(entry.places.size(), 6u);
  for (const TunedPlace& place : entry.places) {
    const double relaxation = relaxation_of(place);
    EXPECT_NEAR(relaxation, 1.7, 0.1);
    EXPECT_NEAR(place.gain(), (0.1 + 0.49) / (0.1 + std::pow(relaxation - 1.7, 2)), 1e-6);
    EXPECT_NEAR(place.step, 0.005, 0.002);
  }
  EXPECT_TRUE(std::ranges::all_of(
      specs, [](const PointSpec& s) { return s.resolution == 50 || s.resolution == 200; }));
}

// Each place has its own best: of tight limits here below where the setting fails.
TEST(Tune, EachPlaceIsTunedForItself) {
  const TunedEntry entry = tune_solver("gauss_seidel_colored", chain(), thorough(), fake(1.4));
  ASSERT_EQ(entry.places.size(), 6u);
  for (const TunedPlace& place : entry.places)
    EXPECT_NEAR(relaxation_of(place), place.limit < 0.005 ? 1.35 : 1.7, 0.1) << place.limit;
}

TEST(Tune, WhatWasFoundAtOnePlaceIsTriedAtTheNext) {
  std::vector<PointSpec> specs;
  const TunedEntry entry =
      tune_solver("gauss_seidel_colored", chain(), {.rules = {.budget = 8}, .longest_run = 10},
                  fake(10, &specs));
  ASSERT_EQ(entry.places.size(), 6u);
  for (std::size_t i = 1; i < entry.places.size(); ++i) {
    const TunedPlace &before = entry.places[i - 1], &here = entry.places[i];
    EXPECT_TRUE(std::ranges::any_of(specs, [&](const PointSpec& s) {
      return s.resolution == here.resolution && s.strain_limit == here.limit &&
             s.settings == before.settings;
    })) << i;
    EXPECT_LE(here.seconds, before.seconds);
  }
}

// A setting whose best step is far from the default's: neither is lost for the other.
TEST(Tune, FindsBestStepsThatLieFarApart) {
  SweepRunners runners = fake(10);
  runners.run = [](const PointSpec& spec, const RunLimits& limits, std::optional<double>) {
    const bool tuned = spec.settings.contains("relaxation") &&
                       std::get<double>(spec.settings.at("relaxation")) > 1.5;
    const double off = std::log2(spec.step * (tuned ? 25 : 250));
    PointResult point;
    point.spec = spec;
    const double seconds = (tuned ? 0.1 : 1) * (1 + off * off);
    // The untuned one does not get through coarse steps.
    point.status = !tuned && spec.step > 0.02  ? PointStatus::not_converged
                   : seconds > limits.hopeless ? PointStatus::timeout
                                               : PointStatus::ok;
    if (point.ok()) point.samples = {seconds};
    return point;
  };
  const TunedEntry entry = tune_solver("gauss_seidel_colored", chain(), thorough(), runners);
  ASSERT_EQ(entry.places.size(), 6u);
  const double off = std::log2(250.0 / 200);  // of the ladder's step next to 1/250 s
  for (const TunedPlace& place : entry.places) {
    EXPECT_GT(relaxation_of(place), 1.5);
    EXPECT_NEAR(place.gain(), 10 * (1 + off * off), 1e-6);
  }
}

TEST(Tune, ALimitThatTheDefaultMissesCountsForNothing) {
  const TunedEntry entry = tune_solver("gauss_seidel_colored", chain(), thorough(), fake(0.9));
  ASSERT_EQ(entry.places.size(), 2u);
  EXPECT_NEAR(relaxation_of(entry.places[0]), 1.7, 0.1);
}

// A cheap run whose motion is wrong is no use to anybody; where nothing is known of errors, it
// counts.
TEST(Tune, OnlyMotionThatIsRightCounts) {
  for (const bool known : {true, false}) {
    SweepRunners runners = fake(10);
    runners.run = [known, run = runners.run](const PointSpec& spec, const RunLimits& limits,
                                             std::optional<double> stiffness) {
      PointResult point = run(spec, limits, stiffness);
      // Fast with much relaxation, but then off by 5 % of the scene's size.
      const auto given = spec.settings.find("relaxation");
      const double relaxation =
          given == spec.settings.end() ? 1.0 : std::get<double>(given->second);
      if (point.ok()) point.samples = {relaxation > 1.9 ? 0.01 : 3 - relaxation};
      if (known) {
        point.measures.trajectory = relaxation > 1.9 ? 0.05 : 0.001;
        point.measures.gap = 1e-6;
      }
      return point;
    };
    const TunedEntry entry = tune_solver("gauss_seidel_colored", chain(), thorough(), runners);
    ASSERT_EQ(entry.places.size(), 6u);
    for (const TunedPlace& place : entry.places)
      EXPECT_EQ(relaxation_of(place) > 1.9, !known) << relaxation_of(place);
  }
}

// Slow solvers are tuned on as many problems as fast ones, on smaller ones.
TEST(Tune, APlaceWhoseRunsAreLongIsTakenAtASmallerSize) {
  const auto sizes = [](double longest_run) {
    const TunedEntry entry =
        tune_solver("gauss_seidel_colored", chain(),
                    {.rules = {.budget = 30}, .longest_run = longest_run}, fake(10));
    EXPECT_EQ(entry.places.size(), 6u);
    std::set<int> found;
    for (const TunedPlace& place : entry.places) found.insert(place.resolution);
    return found;
  };
  EXPECT_EQ(sizes(100), (std::set<int>{50, 200}));
  EXPECT_EQ(sizes(1e-3), (std::set<int>{12})) << "the smallest, though it takes long there too";
}

// A default must not decide at which size a method is tuned: at 200 vertices this one takes too
// long with it, and not with what was found at 50.
TEST(Tune, APlaceStaysWhereWhatWasFoundBeforeIsFastEnough) {
  SweepRunners runners = fake(10);
  runners.run = [](const PointSpec& spec, const RunLimits& limits, std::optional<double>) {
    const auto given = spec.settings.find("relaxation");
    const double relaxation = given == spec.settings.end() ? 1.0 : std::get<double>(given->second);
    PointResult point;
    point.spec = spec;
    point.samples = {spec.resolution / 50.0 * (0.1 + std::pow(relaxation - 1.7, 2))};
    point.status = point.samples[0] > limits.hopeless ? PointStatus::timeout : PointStatus::ok;
    if (!point.ok()) point.samples.clear();
    return point;
  };
  const auto places = [&](double longest_run) {
    TuneOptions options = thorough();
    options.longest_run = longest_run;
    const TunedEntry entry = tune_solver("gauss_seidel_colored", chain(), options, runners);
    return std::count_if(entry.places.begin(), entry.places.end(),
                         [](const TunedPlace& place) { return place.resolution == 200; });
  };
  EXPECT_EQ(places(1), 3);  // 2.4 s without settings, 0.4 s with those found
  EXPECT_EQ(places(0.3), 0);
}

TEST(Tune, AnEntryIsRefusedOnceItsRuleHasChanged) {
  TunedEntry entry =
      tune_solver("gauss_seidel_colored", chain(), {.rules = {.budget = 10}}, fake(10));
  entry.context = {{"date", ""}, {"cpu_model", ""}, {"commit", ""}};
  EXPECT_TRUE(up_to_date(entry));
  const std::string file = ::testing::TempDir() + "/tuned.json";
  const auto message = [&file](const TunedEntry& changed) -> std::string {
    std::ofstream(file) << tuned_document({changed});
    try {
      static_cast<void>(read_tuned_up_to_date(file));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(entry), "");
  TunedEntry without_rule = entry;
  without_rule.rule = nullptr;
  EXPECT_NE(message(without_rule).find("'rule' must be an object"), std::string::npos)
      << message(without_rule);
  TunedEntry heavier = entry;
  heavier.rule["scene_parameters"]["gravity"] = 1.62;
  EXPECT_FALSE(up_to_date(heavier));
  EXPECT_NE(message(heavier).find("gauss_seidel_colored for the chain were found with "
                                  "scene_parameters/gravity = 1.62, which is 9.81 now"),
            std::string::npos)
      << message(heavier);
  TunedEntry narrower = entry;
  narrower.rule["settings"]["relaxation"]["range"][1] = 1.5;
  EXPECT_FALSE(up_to_date(narrower));
  TunedEntry elsewhere = entry;
  elsewhere.rule["sizes"] = {50, 100};
  EXPECT_FALSE(up_to_date(elsewhere));
}

TEST(Tune, ASolverWithNothingToTuneIsNotRun) {
  std::vector<PointSpec> specs;
  const TunedEntry entry = tune_solver("null", chain(), {}, fake(10, &specs));
  EXPECT_TRUE(entry.places.empty());
  EXPECT_TRUE(specs.empty());
}

TEST(Tune, AnInterruptionIsPassedOn) {
  SweepRunners runners = fake(10);
  runners.run = [](const auto&, const auto&, auto) -> PointResult { throw Interrupted(); };
  EXPECT_THROW(static_cast<void>(tune_solver("gauss_seidel_colored", chain(), {}, runners)),
               Interrupted);
}

}  // namespace
}  // namespace harness
