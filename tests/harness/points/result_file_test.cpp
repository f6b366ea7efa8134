// Files that are written or committed fit their schemas, configs/*.schema.json.
#include "harness/points/result_file.h"

#include "harness/analysis/plane.h"
#include "harness/base/table.h"
#include "harness/compare/comparison.h"
#include "harness/points/context.h"
#include "harness/points/schema.h"
#include "harness/points/tuned.h"
#include "harness/run/sweep.h"
#include "harness/stability/stability.h"
#include "support/effort.h"
#include "support/refusal.h"

namespace harness {
namespace {

json read(const std::string& path) { return parse_document(read_file(path, "file"), path); }

// What does not fit configs/<schema>.schema.json, "" if all does.
std::string misfit(const json& document, const std::string& schema) {
  return refusal_of([&] { check_schema(json::parse(document.dump()), schema, "it"); });
}

Suite tiny_suite() {
  Suite suite = read_suite(source_path("configs/pairs.json"));
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

json document_of(const Suite& suite, const std::vector<PointResult>& points) {
  return result_document(machine_context(), suite, {"bench"}, true, points);
}

TEST(ResultFile, OfSweepsFitsTheSchema) {
  if (inextensible::testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  const Suite suite = tiny_suite();
  const auto untimed = [](const PointSpec& spec, RunLimits limits) {
    limits.timed = false;  // one run a sample: nobody reads the times
    return run_point(spec, limits);
  };
  const SweepFilters filters{Pattern("--solver", "fast_projection.*|implicit_springs"), {}, {}};
  const SweepOutcome outcome = run_sweep(suite, plan(suite, filters), {}, untimed);
  const json document = document_of(suite, outcome.points);
  EXPECT_EQ(misfit(document, "result"), "");
  // Benchmarks hold every sample of best points and nothing else: compare.py reads a failed run's
  // time 0 as faster.
  std::size_t samples = 0;
  for (const PointResult& point : outcome.points)
    if (point.ok() && (point.best || !point.best_at_errors.empty() || point.spec.sweep == "step"))
      samples += point.samples.size();
  EXPECT_GT(samples, 0u);
  EXPECT_EQ(document["benchmarks"].size(), samples);
}

TEST(Schemas, AreThoseOfCommittedFiles) {
  if (inextensible::testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  for (const char* folder : {"results", "results/baseline", "configs"})
    for (const auto& entry : std::filesystem::directory_iterator(source_path(folder))) {
      if (entry.path().extension() != ".json") continue;
      const json document = read(entry.path());
      if (!document.contains("schema") && !document.contains("sweeps"))
        continue;  // schemas, the gate, and data of the program
      const std::string kind = document.value("schema", "inextensible-suite/1");
      std::string schema = kind.substr(13, kind.find('/') - 13);
      if (schema == "bench") schema = "result";
      EXPECT_EQ(misfit(document, schema), "") << entry.path();
      if (schema == "result") {
        EXPECT_EQ(misfit(analysis::analysis_of(document), "analysis"), "") << entry.path();
        const analysis::Coverage coverage = analysis::coverage_of(document);
        EXPECT_LE(10 * coverage.outside, coverage.ratios) << entry.path();  // 10 % on another day
      }
      if (schema == "suite") {
        EXPECT_NO_THROW((void)read_suite(entry.path())) << entry.path();
      }
    }
  EXPECT_NO_THROW(static_cast<void>(read_tuned_up_to_date("tuned.json")));
  EXPECT_NO_THROW(static_cast<void>(read_gate(source_path("configs/gate.json"))));
  const json all = {{"counters", {{"names", counter_names()}}}};
  EXPECT_EQ(misfit(all, "gate"), "");
  EXPECT_NO_THROW(static_cast<void>(parse_gate(all.dump(), "all")));
}

TEST(ResultFile, OfAStabilitySweepFitsItsSchema) {
  const StabilityPlan plan =
      plan_stability("quick", Pattern("--solver", "fast_projection|gauss_seidel"),
                     Pattern("--case", "^Q1$|^Q4$|door|triangles|largest step taut"));
  const auto outcome = run_stability(plan, 1, {});
  EXPECT_FALSE(outcome.cells.empty());
  EXPECT_FALSE(outcome.largest_steps.empty());
  EXPECT_FALSE(outcome.freedom.empty());
  const json document = stability_document(machine_context(), outcome, 1, {"bench"});
  EXPECT_EQ(misfit(document, "stability"), "");
}

TEST(ResultFile, NamesItsContestantsAndItsNoise) {
  Suite suite = tiny_suite();
  suite.same = "icd";
  std::vector<PointResult> points;
  for (SweepSpec& sweep : suite.sweeps) add_double(sweep.contestants, suite.same);
  for (const Search& search : plan(suite, {})) {
    if (search.base.solver != suite.same) continue;
    PointResult& point = points.emplace_back(search.base, PointStatus::ok);
    point.samples = {1};
    point.best = true;
  }
  const json document = document_of(suite, points), &known = document["legend"]["solvers"];
  EXPECT_EQ(misfit(document, "result"), "");
  EXPECT_EQ(document["context"]["noise"]["q95"], 0);
  const auto again = std::ranges::find(known, "icd_again", [](const json& s) { return s["name"]; });
  ASSERT_NE(again, known.end());
  EXPECT_EQ((*again)["unranked"], true);
  EXPECT_EQ((*(again - 1))["name"], "icd") << "right after it";
}

// A sound file with one number or word changed that no run can have measured.
TEST(ResultFile, RefusesWhatNoRunCanHaveMeasured) {
  const std::string sound = read_file(source_path("results/figure1.json"), "result file");
  ASSERT_NO_THROW((void)parse_result(sound, "it"));
  const json document = json::parse(sound);
  const auto points = document.at("points");
  const auto at =
      std::ranges::find_if(points, [](const json& p) { return p.at("status") == "ok"; });
  const auto place = static_cast<std::size_t>(at - points.begin());
  const auto refused = [&](const std::string& pointer, const json& value, const char* why) {
    json changed = document;
    changed["points"][place][json::json_pointer(pointer)] = value;
    EXPECT_TRUE(refuses([&] { (void)parse_result(changed.dump(), "it"); }, why)) << pointer;
  };
  refused("/status", "fine", "\"fine\"");
  refused("/work/luck", 1, "unknown key 'luck'");
  const std::string times = "seconds_per_simulated_second";
  const double median = at->at(times).at("median");
  for (const char* quantile : {"/min", "/q1", "/median", "/q3"})
    refused("/" + times + quantile, 1.5 * median + 1e-9, "not those of its samples");
  refused("/" + times + "/samples/0", 0, "not positive");
  refused("/max_strain", 1.1 * at->at("strain_limit").get<double>(), "more strain than its limit");
  refused("/error/trajectory", -1e-3, "negative error");
  json failed = *at;
  failed["best"] = true;
  failed["status"] = "diverged";
  refused("", failed, "did not end well");
  json twice = points.at(place == 0 ? 1 : 0);
  twice["status_detail"] = "faster";
  refused("", twice, "is there twice");
}

TEST(ResultFile, TextsControlNoTerminal) {
  const std::string hostile = "\x1b[31m a\u202e b\u0085\u2066\ufeff\n <script>";
  json document = read(source_path("results/figure1.json"));
  document["points"][0]["status_detail"] = hostile;
  const json read = parse_result(document.dump(), "it");
  EXPECT_EQ(read.at("points").at(0).at("status_detail"), "?[31m a? b???? <script>");
  std::ostringstream page;
  print_markdown(page, {{"a"}, {{"x`y|"}, {hostile}}, 1});
  print_markdown(page, {{"a", "b"}, {{"x", "<script>|</script>, 1 < 2, <= 3"}}});
  EXPECT_NE(page.str().find("| `x'y\\|` |"), std::string::npos) << page.str();
  EXPECT_NE(page.str().find("&lt;script>\\|&lt;/script>, 1 < 2, <= 3"), std::string::npos);
}

}  // namespace
}  // namespace harness
