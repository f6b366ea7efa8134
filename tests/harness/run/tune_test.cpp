// The search for settings, with objectives whose optimum is known, and with a fake clock.
#include "harness/run/tune.h"

#include <fstream>
#include <random>
#include <set>

#include "harness/run/fake_machine.h"
#include "support/refusal.h"

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

// The second time with a region that fails.
TEST(TuneSearch, FindsTheLowestPointOfASmoothFunction) {
  for (const bool fails : {false, true}) {
    const auto seconds = [fails](const Values& v, double) -> std::optional<double> {
      if (fails && (v[0] > 1.75 || v[2] > 40)) return {};
      return bowl(v);
    };
    const TuneOutcome found = tune_values(numbers(), seconds, 60);
    EXPECT_LT(bowl(found.values), fails ? 1.1 : 1.06);  // what is within 5 % is not worth a change
    EXPECT_TRUE(seconds(found.values, 1e300));
    EXPECT_LE(found.evaluations, 60);
    EXPECT_EQ(found.values[2], std::round(found.values[2]));
    EXPECT_EQ(tune_values(numbers(), seconds, 60).values, found.values);
  }
}

// A narrow valley across both ranges, like that of relaxation and target: changing one setting
// alone gains next to nothing. At most 10 % may be left to gain.
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
    if (*seconds(tune_values(two, seconds, 40).values, 0) < 1.1) ++within_10_percent;
  }
  EXPECT_GE(within_10_percent, valleys * 90 / 100);
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
    const TuneOutcome found = tune_values(numbers(), seconds, 20);
    EXPECT_EQ(calls, found.evaluations);
    EXPECT_LE(calls, 20);
    EXPECT_LE(truth(found.values), truth({1, 0.1, 0}));
  }
  const auto fails = [](const Values&, double) { return std::optional<double>(); };
  EXPECT_EQ(tune_values(numbers(), fails, 40).evaluations, 1) << "nothing to compare it with";
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

// Colored Gauss-Seidel's fake time is lowest at a relaxation of 1.7 and a step of 1/200 s.
double relaxation_of(const Settings& settings) {
  const auto found = settings.find("relaxation");
  return found == settings.end() ? 1.0 : std::get<double>(found->second);
}

double bowl_of(const PointSpec& spec) {
  const double off = std::log2(spec.step * 200);
  return (0.1 + std::pow(relaxation_of(spec.settings) - 1.7, 2)) * (1 + off * off);
}

TunedEntry tuned(FakeMachine& machine, const TuneOptions& options = {
                                           .budget = 60, .trials_each = 30, .longest_run = 10}) {
  machine.stops = true;
  TunedEntry entry =
      tune_solver("gauss_seidel_colored", tuning_scenes().front(), options, machine.runner());
  EXPECT_EQ(entry.places.size(), 6u);
  return entry;
}

TEST(Tune, FindsASettingAndSaysWhatItGains) {
  FakeMachine machine{bowl_of};
  const TunedEntry entry = tuned(machine);
  EXPECT_EQ(entry.kind, "chain");
  for (const TunedPlace& place : entry.places) {
    const double relaxation = relaxation_of(place.settings);
    EXPECT_NEAR(relaxation, 1.7, 0.1);
    EXPECT_NEAR(place.gain(), (0.1 + 0.49) / (0.1 + std::pow(relaxation - 1.7, 2)), 1e-6);
    EXPECT_NEAR(place.step, 0.005, 0.002);
  }
  EXPECT_TRUE(std::ranges::all_of(
      machine.specs, [](const PointSpec& s) { return s.resolution == 50 || s.resolution == 200; }));
  for (std::size_t i = 1; i < entry.places.size(); ++i) {  // what was found is tried at the next
    EXPECT_TRUE(std::ranges::any_of(machine.specs, [&](const PointSpec& s) {
      return s.resolution == entry.places[i].resolution &&
             s.strain_limit == entry.places[i].limit && s.settings == entry.places[i - 1].settings;
    })) << i;
    EXPECT_LE(entry.places[i].seconds, entry.places[i - 1].seconds);
  }
}

// Tight limits are missed above some relaxation, even by the default: each place has its own best.
TEST(Tune, EachPlaceIsTunedForItself) {
  for (const double fails_above : {1.4, 0.9}) {
    FakeMachine machine{bowl_of, [fails_above](const PointSpec& spec) {
                          return spec.strain_limit < 0.005 &&
                                         relaxation_of(spec.settings) > fails_above
                                     ? PointStatus::strain_missed
                                     : PointStatus::ok;
                        }};
    const TunedEntry entry = tuned(machine);
    for (const TunedPlace& place : entry.places)
      EXPECT_NEAR(relaxation_of(place.settings), place.limit < 0.005 ? fails_above - 0.05 : 1.7,
                  0.1)
          << place.limit;
  }
}

// A place of one's own begins with the nearest place's settings. What is best elsewhere is tried
// next, and begins the search if no step counts with the nearest ones.
TEST(Tune, WhatIsBestElsewhereIsTriedBeforeAnythingIsDrawn) {
  SweepSpec chain = tuning_scenes().front();
  chain.resolutions = {80};
  chain.limits = {0.01};
  const Settings nearest{{"relaxation", 1.9}}, elsewhere{{"relaxation", 1.7}};
  TunedEntry known;
  known.places = {{{50, 0.02, nearest}}};
  for (const bool nearest_fails : {false, true}) {
    FakeMachine machine{
        [&](const PointSpec& spec) { return spec.settings == elsewhere ? 0.1 : 1.0; },
        [&](const PointSpec& spec) {
          return nearest_fails && spec.settings != elsewhere ? PointStatus::diverged
                                                             : PointStatus::ok;
        }};
    const TunedEntry entry = tune_solver("gauss_seidel_colored", chain, {.budget = 5},
                                         machine.runner(), &known, {elsewhere});
    ASSERT_EQ(entry.places.size(), 1u);
    EXPECT_EQ(entry.places.front().settings, elsewhere) << nearest_fails;
    EXPECT_EQ(machine.specs.front().settings, nearest);
  }
}

// A fast run whose motion is wrong by 5 % of the scene's size counts only if its error is unknown.
TEST(Tune, OnlyMotionThatIsRightCounts) {
  const auto wrong = [](const Settings& given) { return relaxation_of(given) > 1.9; };
  for (const bool known : {true, false}) {
    FakeMachine machine{[=](const PointSpec& spec) {
      return wrong(spec.settings) ? 0.01 : 3 - relaxation_of(spec.settings);
    }};
    if (known)
      machine.error = [=](const PointSpec& spec) { return wrong(spec.settings) ? 0.05 : 0.001; };
    const TunedEntry entry = tuned(machine);
    for (const TunedPlace& place : entry.places) EXPECT_EQ(wrong(place.settings), !known);
  }
}

// A slow solver is tuned at smaller sizes, but its default must not decide that: at 200 vertices
// the growing machine takes 2.4 s with the default and 0.4 s with the setting found at 50.
TEST(Tune, APlaceWithLongRunsGetsASmallerSize) {
  const auto sizes = [](auto seconds, TuneOptions options, double longest_run) {
    options.longest_run = longest_run;
    FakeMachine machine{seconds};
    std::multiset<int> found;
    for (const TunedPlace& place : tuned(machine, options).places) found.insert(place.resolution);
    return found;
  };
  using Sizes = std::multiset<int>;
  const TuneOptions few{.budget = 30}, many{.budget = 60, .trials_each = 30};
  EXPECT_EQ(sizes(bowl_of, few, 100), (Sizes{50, 50, 50, 200, 200, 200}));
  EXPECT_EQ(sizes(bowl_of, few, 1e-3), (Sizes{12, 12, 12, 12, 12, 12}))
      << "the smallest, though it takes long there too";
  const auto growing = [](const PointSpec& spec) {
    return spec.resolution / 50.0 * (0.1 + std::pow(relaxation_of(spec.settings) - 1.7, 2));
  };
  EXPECT_EQ(sizes(growing, many, 1).count(200), 3u);
  EXPECT_EQ(sizes(growing, many, 0.3).count(200), 0u);
}

TEST(Tune, AnEntryIsRefusedOnceItsRuleHasChanged) {
  FakeMachine machine{bowl_of};
  const TunedEntry entry = tuned(machine, {.budget = 10});
  const struct {
    const char* place;
    json was;
    std::string change;
  } rows[] = {
      {"/scene", "chain", ""},
      {"/scene_parameters/gravity", 1.62, "scene_parameters/gravity is 9.81, was 1.62"},
      {"/settings/relaxation/range/1", 1.5, "settings/relaxation/range/1 is 1.998, was 1.5"},
      {"/sizes", {50, 100}, "sizes/1 is 200, was 100"}};
  for (const auto& row : rows) {
    TunedEntry other = entry;
    other.context = {{"date", ""}, {"cpu_model", ""}, {"commit", ""}};
    other.rule[json::json_pointer(row.place)] = row.was;
    EXPECT_EQ(rule_change(other), row.change);
    const std::string file = ::testing::TempDir() + "/tuned.json";
    std::ofstream(file) << tuned_document({other});
    const std::string message = refusal_of([&file] { (void)read_tuned_up_to_date(file); });
    EXPECT_NE(message.find(row.change), std::string::npos) << message;
    EXPECT_EQ(message.empty(), row.change.empty()) << message;
  }
}

TEST(Tune, ASolverWithNothingToTuneIsNotRunAndAnInterruptionIsPassedOn) {
  FakeMachine machine{bowl_of};
  EXPECT_TRUE(tune_solver("null", tuning_scenes().front(), {}, machine.runner()).places.empty());
  EXPECT_TRUE(machine.specs.empty());
  machine.status = [](const auto&) -> PointStatus { throw Interrupted(); };
  EXPECT_THROW(static_cast<void>(tuned(machine)), Interrupted);
}

}  // namespace
}  // namespace harness
