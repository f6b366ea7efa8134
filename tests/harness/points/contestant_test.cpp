// One solver several times in a run, tuned settings, and the noise between two equal contestants.
#include "harness/points/contestant.h"

#include <fstream>

#include "harness/points/result_file.h"
#include "harness/points/tuned.h"
#include "harness/run/sweep.h"
#include "support/invented_runs.h"
#include "support/refusal.h"

namespace harness {
namespace {

std::string write_tuned(const std::vector<TunedEntry>& entries) {
  const std::string path = ::testing::TempDir() + "tuned_of_test.json";
  std::ofstream(path) << tuned_document(entries);
  return path;
}

TunedPlace place_at(int resolution, double limit, const Settings& settings) {
  return {{resolution, limit, settings}, 12, 2, 0.005, 1, 0.01};
}

TunedEntry of_the_drape(const std::string& solver, const Settings& settings) {
  const SweepSpec& scene = tuning_scenes().at(1);
  return {scene.scene,
          solver,
          40,
          {place_at(25, 0.02, settings)},
          tuning_rule(scene, *find_backend(solver)),
          {{"date", ""}, {"cpu_model", ""}, {"commit", ""}}};
}

std::string suite_text(const std::string& everywhere, const std::string& of_sweep,
                       const std::string& scene = "chain") {
  return "{" + everywhere + R"("sweeps": [{"sweep": "strain", "scene": ")" + scene + "\", " +
         of_sweep + "}]}";
}

Suite suite_with(const std::string& everywhere, const std::string& of_sweep,
                 const std::string& scene = "chain") {
  return parse_suite(suite_text(everywhere, R"("limits": [0.1], )" + of_sweep, scene), "suite");
}

std::vector<std::string> names(const Suite& suite) {
  return names_of(suite.sweeps.at(0).contestants);
}

double setting(const Search& search, const char* name) {
  return std::get<double>(search.base.settings.at(name));
}

// Those of a suite that names none: soft_step takes no collider, and yarn projection on a chain is
// fast_projection_adaptive.
TEST(Contestants, TakeEveryPartOfTheSceneAndAreNotTwiceOnAChain) {
  const auto stands = [](const char* scene, const char* name) {
    const auto all = names(suite_with("", R"("steps": {"finest": 0.001})", scene));
    return std::ranges::count(all, name) > 0;
  };
  EXPECT_TRUE(stands("chain", "soft_step"));
  EXPECT_FALSE(stands("drape", "soft_step"));
  EXPECT_TRUE(stands("drape", "yarn_projection"));
  EXPECT_FALSE(stands("chain", "yarn_projection"));
}

TEST(Contestants, HaveTheirOwnNamesAndSettings) {
  const Suite suite =
      suite_with(R"("same": "jacobi_slow", )", R"("solvers": ["jacobi", {"name": "jacobi_slow",
      "solver": "jacobi", "settings": {"relaxation": 1.2}, "unranked": true}],
      "solver_options": {"jacobi": {"relaxation": 1.5, "target": 0.5}})");
  const auto searches = plan(suite, {});
  EXPECT_EQ(names(suite), (std::vector<std::string>{"jacobi", "jacobi_slow", "jacobi_slow_again"}));
  ASSERT_EQ(searches.size(), 3u);
  EXPECT_EQ(searches[1].base.settings, searches[2].base.settings);
  EXPECT_EQ(setting(searches[0], "relaxation"), 1.5);
  EXPECT_EQ(setting(searches[1], "relaxation"), 1.2) << "a contestant's own settings go first";
  EXPECT_EQ(setting(searches[1], "target"), 0.5) << "the solver's are for all of it";
  EXPECT_NE(searches[1].base.id().find("/jacobi_slow/"), std::string::npos);
  EXPECT_NE(searches[0].family, searches[1].family);
  SweepFilters filters;
  filters.solver = Pattern("--solver", "jacobi_.*");
  EXPECT_EQ(plan(suite, filters).size(), 2u);
  const Suite again = parse_suite(to_json(suite).dump(), "again");
  EXPECT_EQ(to_json(again), to_json(suite));
  EXPECT_EQ(again.sweeps[0].contestants, suite.sweeps[0].contestants);
}

// The message for a wrong suite names the key or value.
TEST(Suite, NamesFileKeyAndValueOfWhatIsWrong) {
  const auto sweep = [](const char* rest) { return suite_text("", rest); };
  const auto solvers = [&](const char* list) {
    return suite_text("", std::string(R"("limit": 0.1, "solvers": [)") + list + "]");
  };
  EXPECT_NO_THROW(static_cast<void>(parse_suite(sweep(R"("limits": [0.1])"), "suite.json")));
  const std::pair<std::string, const char*> suites[] = {
      {"{ nonsense", "is not JSON"},
      {"[]", "'suite.json' is not a suite file: at its top"},
      {suite_text(R"("name": "../x", )", R"("limit": 0.1)"), "'name' is"},
      {suite_text(R"("reps": 0, )", R"("limit": 0.1)"), "at [reps], 0: "},
      {suite_text("", R"("limit": 0.1)", "drap"), "did you mean 'drape'"},
      {sweep(R"("limit": 0.1, "solver": ["icd"])"), "unknown key 'solver'; did you mean 'solvers'"},
      {sweep(R"("limit": 0.1, "scene_parameters": {"n": 1})"), "'n' is 1"},
      {sweep(R"("limit": 0.1, "scene_parameters": {"m": 1})"), "no parameter of scene chain 'm'"},
      {sweep(R"("limit": 0.1, "scene_parameters": {"duration": 1e9})"), "'duration'"},
      {sweep(R"("limit": 0.1, "solver_options": {"icd": {"max_iteration": 3}})"),
       "did you mean 'max_iterations'"},
      {solvers(R"("jacobi", "jacobi")"), "'jacobi' is listed twice"},
      {solvers(R"({"name": "icd", "solver": "jacobi"})"), "another solver"},
      {solvers(R"({"name": "my solver", "solver": "icd"})"), "a-z, 0-9 and _"},
      {solvers(R"({"name": "x", "solver": "idc"})"), "did you mean 'icd'"},
      {suite_text(R"("same": "idc", )", R"("limit": 0.1, "solvers": ["icd"])"),
       "did you mean 'icd'"},
      {suite_text(R"("tuned": "no_such.json", )", R"("limit": 0.1)"), "no_such.json"}};
  for (const auto& [text, part] : suites)
    EXPECT_TRUE(refuses([&suite = text] { (void)parse_suite(suite, "suite.json"); }, part));
}

TEST(Tuned, SettingsAreUsedForTheirKindOfSceneAndBelowWhatASuiteSays) {
  const std::string file =
      write_tuned({of_the_drape("jacobi", {{"relaxation", 1.6}}), of_the_drape("icd", {})});
  const std::string tuned = R"("tuned": ")" + file + R"(", )";
  const std::string both = R"("solvers": ["jacobi", "icd"])";
  const Suite drape = suite_with(tuned, both, "drape");
  EXPECT_EQ(names(drape), (std::vector<std::string>{"jacobi", "icd"}));
  const auto searches = plan(drape, {});
  EXPECT_EQ(setting(searches[0], "relaxation"), 1.6);
  EXPECT_TRUE(searches[1].base.settings.empty());
  EXPECT_EQ(setting(plan(suite_with(tuned, both, "folded_drape"), {})[0], "relaxation"), 1.6)
      << "it is like a drape";
  EXPECT_TRUE(plan(suite_with(tuned, both), {})[0].base.settings.empty()) << "a chain is not";

  const Suite given =
      suite_with(tuned, both + R"(, "solver_options": {"jacobi": {"relaxation": 1.1}})", "drape");
  EXPECT_EQ(setting(plan(given, {})[0], "relaxation"), 1.1);

  // What was run is what the result's suite says, whatever becomes of the file.
  write_tuned({});
  EXPECT_EQ(to_json(parse_suite(to_json(drape).dump(), "again")), to_json(drape));
}

TEST(Tuned, SettingsAreThoseOfTheNearestSizeAndLimit) {
  TunedEntry entry = of_the_drape("jacobi", {{"relaxation", 1.1}});
  entry.places.push_back(place_at(25, 0.0002, {{"relaxation", 1.2}}));
  entry.places.push_back(place_at(55, 0.02, {{"relaxation", 1.3}}));
  entry.places.push_back(place_at(55, 0.0002, {}));
  const Suite suite =
      parse_suite(R"({"tuned": ")" + write_tuned({entry}) +
                      R"(", "sweeps": [{"sweep": "resolution", "scene": "drape", "limits":
                      [0.1, 0.0001], "resolutions": [21, 71], "solvers": ["jacobi"]}]})",
                  "suite");
  std::map<std::pair<int, double>, double> found;
  for (const Search& search : plan(suite, {})) {
    const auto& settings = search.base.settings;
    found[{search.base.resolution, search.base.strain_limit}] =
        settings.empty() ? 0 : std::get<double>(settings.at("relaxation"));
  }
  EXPECT_EQ(found,
            (std::map<std::pair<int, double>, double>{
                {{21, 0.1}, 1.1}, {{21, 0.0001}, 1.2}, {{71, 0.1}, 1.3}, {{71, 0.0001}, 0}}));
}

TEST(Tuned, AFileIsReadAsItIsWrittenAndItsHashIsThatOfItsSettings) {
  TunedEntry e = of_the_drape("jacobi", {{"relaxation", 1.7}});
  const std::string text = tuned_document({e}).dump();
  const Tuned once = parse_tuned(text, "t");
  ASSERT_EQ(once.entries.size(), 1u);
  EXPECT_EQ(tuned_document(once.entries).dump(), text);
  e.places[0].seconds = 7;
  EXPECT_EQ(parse_tuned(tuned_document({e}).dump(), "t").hash, once.hash);
  e.places[0].settings["relaxation"] = 1.71;
  EXPECT_NE(parse_tuned(tuned_document({e}).dump(), "t").hash, once.hash);
  for (const auto& [from, to] :
       {std::pair("1.7", "7.5"), std::pair("relaxation", "relation"), std::pair("jacobi", "jakobi"),
        std::pair("drape", "grape"), std::pair("0.005", "-1"), std::pair("tuned/3", "tuned/9")}) {
    std::string wrong = text;
    wrong.replace(wrong.find(from), std::string(from).size(), to);
    EXPECT_THROW(static_cast<void>(parse_tuned(wrong, "t")), UsageError) << to;
  }
}

PointResult timed(const std::string& contestant, double limit, double step, double seconds,
                  const char* sweep = "strain") {
  PointResult point = point_of(invented::run(contestant, limit, step, seconds, 0, true));
  point.spec.sweep = sweep;
  return point;
}

TEST(Noise, IsTheSpreadOfThePairsRatiosWhateverItsSteps) {
  std::vector<PointResult> points;
  for (int i = 1; i <= 21; ++i) {  // |log ratio|s of 0, 0.01, ..., 0.2
    const double log_ratio = 0.01 * (i - 1) * (i % 2 == 0 ? 1 : -1);
    points.push_back(timed("icd", 0.001 * i, 0.01, i));
    points.push_back(timed("icd_again", 0.001 * i, 0.005, i * std::exp(log_ratio)));
  }
  points.push_back(timed("icd", 0.5, 0.01, 1));
  points.push_back(timed("icd_again", 0.5, 0.01, 100));
  points.back().best = false;
  points.push_back(timed("jacobi", 0.001, 0.01, 100));
  const auto noise = pair_noise(points, "icd");
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->places, 21);
  EXPECT_NEAR(noise->median, 0.1, 1e-12);
  EXPECT_NEAR(noise->q95, 0.19, 1e-12);
  EXPECT_EQ(noise_of({{"noise", *noise}})->q95, noise->q95);
  EXPECT_FALSE(noise_of(json::object()));
  EXPECT_FALSE(pair_noise(points, "jacobi"));
  // A step sweep compares equal steps.
  const auto of_steps =
      pair_noise({timed("icd", 0.1, 0.01, 1, "step"), timed("icd", 0.1, 0.005, 2, "step"),
                  timed("icd_again", 0.1, 0.005, 2.2, "step")},
                 "icd");
  ASSERT_TRUE(of_steps);
  EXPECT_EQ(of_steps->places, 1);
  EXPECT_NEAR(of_steps->q95, std::log(1.1), 1e-12);
}

}  // namespace
}  // namespace harness
