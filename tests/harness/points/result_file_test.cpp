// Every written file fits configs/result.schema.json, every suite fits configs/suite.schema.json.
#include "harness/points/result_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_text.h"
#include "harness/claims/claims.h"
#include "harness/compare/comparison.h"
#include "harness/points/context.h"
#include "harness/points/point_json.h"
#include "harness/points/schema.h"
#include "harness/points/tuned.h"
#include "harness/run/sweep.h"
#include "harness/stability/stability.h"

namespace harness {
namespace {

using nlohmann::json;

std::string source(const std::string& relative) { return std::string(SOURCE_DIR) + "/" + relative; }

json read(const std::string& path) {
  std::ifstream file(path);
  return json::parse(file, nullptr, true, true);
}

// What does not fit configs/<schema>.schema.json, "" if all does.
std::string misfit(const json& document, const std::string& schema) {
  try {
    check_schema(json::parse(document.dump()), schema, "it");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

Suite tiny_suite() {
  Suite suite = read_suite(source("configs/quick.json"));
  for (SweepSpec& sweep : suite.sweeps) {
    sweep.resolutions = {5};
    sweep.limits = {0.01};
    if (sweep.scene == "drape") sweep.scene_parameters["subdivisions"] = 1;
    sweep.finest = 1.0 / 800;
    sweep.scene_parameters["duration"] = 0.2;
  }
  suite.reps = 2;
  return suite;
}

TEST(ResultFile, OfAllSolversOnBothScenesFitsTheSchemaAndComesBackAsItWas) {
  const Suite suite = tiny_suite();
  const SweepRunners runners = limited({}, [](RunLimits limits) {
    limits.timed = false;  // one run a sample: nobody reads the times
    return limits;
  });
  const SweepOutcome outcome = run_sweep(suite, plan(suite, {}), {}, runners);
  for (const PointResult& point : outcome.points) {
    const json written = json::parse(to_json(point).dump());
    EXPECT_EQ(to_json(point_of(written)), written) << point.spec.id();
  }
  const json document = result_document(machine_context(), suite, {"bench"}, true, outcome.points);
  EXPECT_EQ(misfit(document, "result"), "");
  for (const auto& backend : inextensible::backends()) {
    if (!backend.contestant) continue;
    for (const char* scene : {"chain", "drape"}) {
      const bool chain = std::string(scene) == "chain";
      if (chain ? *backend.same_on_chains != 0 : !backend.takes_collider) continue;
      EXPECT_TRUE(std::any_of(outcome.points.begin(), outcome.points.end(),
                              [&](const PointResult& p) {
                                return p.spec.scene == scene && p.spec.solver == backend.name &&
                                       p.ok();
                              }))
          << scene << " " << backend.name;
    }
  }
  // Benchmarks hold every sample of ok points and nothing else: compare.py reads a failed run's
  // time 0 as faster.
  std::size_t samples = 0;
  for (const PointResult& point : outcome.points) samples += point.ok() ? point.samples.size() : 0;
  EXPECT_EQ(document["benchmarks"].size(), samples);
}

TEST(ResultFile, TheSchemaRefusesAWrongStatusAndAnUnknownCounter) {
  const Suite suite = tiny_suite();
  const PointResult point(plan(suite, {}).front().base);
  const json good = result_document(machine_context(), suite, {"bench"}, true, {point});
  ASSERT_EQ(misfit(good, "result"), "");
  json bad = good;
  bad["points"][0]["status"] = "fine";
  EXPECT_NE(misfit(bad, "result"), "");
  bad = good;
  bad["points"][0]["work"]["luck"] = 1;
  EXPECT_NE(misfit(bad, "result"), "");
}

TEST(ResultFile, OfAnUntimedRunIsNotReadForItsTimes) {
  json document = result_document(machine_context(), tiny_suite(), {"bench"}, true, {});
  EXPECT_TRUE(is_timed(document)) << "older files do not say";
  for (const bool timed : {true, false}) {
    document["context"]["timed"] = timed;
    EXPECT_EQ(is_timed(document), timed);
    EXPECT_EQ(misfit(document, "result"), "");
    ComparedResult one, other;
    one.context = other.context = {{"fingerprint", "x"}, {"cpu_model", "m"}};
    other.context["timed"] = timed;
    EXPECT_EQ(comparability(one, other, {}).times(), timed);
    EXPECT_EQ(comparability(other, one, {}).times(), timed);
  }
  EXPECT_THROW(static_cast<void>(judge_claims({document})), UsageError);
}

TEST(ResultFile, CommittedResultsFitTheSchema) {
  for (const auto& entry : std::filesystem::directory_iterator(source("results"))) {
    if (entry.path().extension() != ".json") continue;
    const json document = read(entry.path());
    const std::string kind = document.at("schema");
    const std::string schema = kind == "inextensible-bench/1"       ? "result"
                               : kind == "inextensible-stability/1" ? "stability"
                                                                    : "answers";
    EXPECT_EQ(misfit(document, schema), "") << entry.path();
  }
}

TEST(ResultFile, IsOnePointALine) {
  const Suite suite = tiny_suite();
  const PointResult point(plan(suite, {}).front().base);
  const json document = result_document(machine_context(), suite, {"bench"}, true, {point, point});
  const std::string text = result_text(document);
  EXPECT_EQ(json::parse(text), document);
  std::istringstream lines(text);
  int points = 0;
  for (std::string line; std::getline(lines, line);) points += line.starts_with(R"({"adaptive")");
  EXPECT_EQ(points, 2);
}

TEST(ResultFile, OfAStabilitySweepFitsItsSchema) {
  const auto cases = hard_cases(hard_case_values("quick"));
  StabilityFilters filters;
  filters.solver = harness::Pattern("--solver", "fast_projection|gauss_seidel");
  filters.hard_case = harness::Pattern("--case", "^Q1$|^Q4$|door|triangles|largest step taut");
  const auto outcome = run_stability(plan_stability(cases, filters), 1, {});
  EXPECT_FALSE(outcome.cells.empty());
  EXPECT_FALSE(outcome.largest_steps.empty());
  EXPECT_FALSE(outcome.freedom.empty());
  const json document = stability_document(machine_context(), outcome, 1, {"bench"});
  EXPECT_EQ(misfit(document, "stability"), "");
}

TEST(Configs, FitTheirSchemasAndAreAccepted) {
  for (const char* name : {"quick", "default", "paper", "large"}) {
    const std::string file = source(std::string("configs/") + name + ".json");
    EXPECT_EQ(misfit(read(file), "suite"), "") << name;
    EXPECT_NO_THROW(static_cast<void>(read_suite(file))) << name;
  }
  EXPECT_EQ(misfit(read(source("configs/tuned.json")), "tuned"), "");
  EXPECT_NO_THROW(static_cast<void>(read_tuned_up_to_date("tuned.json")));
  TunedEntry entry{
      "chain", "icd", 3, {{{50, 0.01, {{"max_iterations", 3.0}}}, 2, 2, 0.01, 1, 0.02}}, {}, {}};
  entry.rule = tuning_rule(tuning_scenes().front(), *inextensible::find_backend("icd"));
  entry.context = {{"date", "d"}, {"cpu_model", "c"}, {"commit", "c"}};
  EXPECT_EQ(misfit(tuned_document({entry}), "tuned"), "");
  entry.context.erase("date");
  EXPECT_NE(misfit(tuned_document({entry}), "tuned"), "");
  EXPECT_EQ(misfit(read(source("configs/gate.json")), "gate"), "");
  EXPECT_NO_THROW(static_cast<void>(read_gate(source("configs/gate.json"))));
  EXPECT_NE(misfit({{"times", {{"cout", true}}}}, "gate"), "");
  const json all = {{"counters", {{"names", counter_names()}}}};
  EXPECT_EQ(misfit(all, "gate"), "");
  EXPECT_NO_THROW(static_cast<void>(parse_gate(all.dump(), "all")));
}

TEST(ResultFile, SaysWhereItsSettingsAreFromWhoIsWhoAndHowNoisyItIs) {
  Suite suite = tiny_suite();
  suite.tuned_file = "tuned.json";
  suite.tuned_hash = "0";
  suite.same = "icd";
  std::vector<PointResult> points;
  for (SweepSpec& sweep : suite.sweeps) add_double(sweep.contestants, "icd");
  for (const Search& search : plan(suite, {})) {
    if (search.base.solver != "icd") continue;
    points.emplace_back().spec = search.base;
    points.back().spec.step = 0.01;
    points.back().status = PointStatus::ok;
    points.back().samples = {1};
    points.back().best = true;
  }
  const json document = result_document(machine_context(), suite, {"bench"}, true, points);
  EXPECT_EQ(misfit(document, "result"), "");
  EXPECT_EQ(document["context"]["tuned"]["file"], "tuned.json");
  EXPECT_EQ(document["context"]["noise"]["q95"], 0);
  const auto known = document["legend"]["solvers"];
  const auto again = std::find_if(known.begin(), known.end(),
                                  [](const json& s) { return s["name"] == "icd_again"; });
  ASSERT_NE(again, known.end());
  EXPECT_EQ((*again)["unranked"], true);
  EXPECT_EQ((*(again - 1))["name"], "icd");
}

TEST(Baselines, FitTheirSchema) {
  const Suite suite = tiny_suite();
  const PointResult point(plan(suite, {}).front().base);
  const json result = result_document(machine_context(), suite, {"bench"}, true, {point});
  const std::string path = ::testing::TempDir() + "of_baseline.json";
  write_atomically(path, result.dump());
  const json baseline = json::parse(document_text(baseline_document(read_compared({path}))));
  EXPECT_EQ(misfit(baseline, "baseline"), "");
  json bad = baseline;
  bad["points"][0]["seconds"] = 1;
  EXPECT_NE(misfit(bad, "baseline"), "");
  for (const auto& entry : std::filesystem::directory_iterator(source("results/baseline")))
    EXPECT_EQ(misfit(read(entry.path()), "baseline"), "") << entry.path();
}

TEST(WriteAtomically, KeepsTheOldFileWhenTheNewOneCannotBeWritten) {
  const std::string path = ::testing::TempDir() + "kept.json";
  write_atomically(path, "old");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{10, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_atomically(path, "new, and longer than a file may be"), std::runtime_error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  std::ifstream file(path);
  std::string text;
  file >> text;
  EXPECT_EQ(text, "old");
  EXPECT_THROW(check_writable(::testing::TempDir()), UsageError);  // a folder
}

}  // namespace
}  // namespace harness
