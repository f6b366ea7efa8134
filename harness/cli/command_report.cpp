// bench report: one page that tells what result files found.
#include <filesystem>

#include "harness/analysis/analysis_json.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/claims/claims.h"
#include "harness/cli/figures.h"
#include "harness/cli/verbs.h"
#include "harness/film/recording.h"
#include "harness/points/joined.h"
#include "harness/points/result_file.h"
#include "harness/points/tuned.h"

namespace harness {
namespace {

nlohmann::json claims_json(const std::vector<ClaimVerdict>& claims) {
  nlohmann::json rows = nlohmann::json::array();
  for (const ClaimVerdict& claim : claims)
    rows.push_back({{"id", claim.id},
                    {"statement", claim.statement},
                    {"verdict", claim.verdict},
                    {"measured", claim.measured},
                    {"rule", claim.rule}});
  return rows;
}

// What the page says and draws: the analysis of each sweep by its file's name, and the findings of
// all, those of pieces of one sweep taken together.
nlohmann::json analyses_json(const std::vector<NamedResult>& results) {
  nlohmann::json of = nlohmann::json::object();
  std::vector<nlohmann::json> sweeps;
  for (const NamedResult& result : results) {
    if (!result.document.contains("points")) continue;
    of[result.name] = analysis::analysis_of(result.document);
    sweeps.push_back(result.document);
  }
  nlohmann::json findings = nlohmann::json::array();
  if (!sweeps.empty()) {
    const nlohmann::json table = joined(sweeps);
    findings = analysis::findings_json(analysis::planes_of(table));
  }
  return {{"findings", std::move(findings)}, {"of", std::move(of)}};
}

// By three methods at 1 %, small enough for a page.
FilmSpec motion(const std::string& scene, const SceneParameters& given) {
  const auto type = find_scene(scene);
  FilmSpec spec;
  spec.scene = scene;
  spec.parameters = complete_parameters(*type, given);
  for (const char* solver : {"gauss_seidel_colored", "fast_projection", "fast_projection@bdf2"})
    spec.solvers.push_back({solver, solver});
  tune(spec.solvers, read_tuned_up_to_date("tuned.json"), type->kind(), {}, false);
  spec.strain_limits = {0.01};
  return spec;
}

std::string record_into(const std::string& folder, const FilmSpec& spec) {
  std::filesystem::create_directory(folder);
  write_recording(folder, record(spec, interrupted, [](auto&&...) {}));
  return folder;
}

struct ReportOptions {
  std::vector<std::string> results, answers;
  std::string out;
  bool no_motion = false;
};

int report(const ReportOptions& given) {
  check_writable(given.out);
  std::vector<NamedResult> results;
  for (const std::string& file : given.results) {
    NamedResult result{file, read_result_or_answers(file)};
    if (!is_answers(result.document)) results.push_back(std::move(result));
  }
  for (const std::string& file : given.answers) (void)read_answers(file);
  std::vector<nlohmann::json> documents;
  documents.reserve(results.size());
  for (const NamedResult& result : results) documents.push_back(result.document);
  const TemporaryFolder folder("report");
  std::vector<std::string> words = given.results;
  words.insert(words.end(), given.answers.begin(), given.answers.end());
  words.insert(words.end(), {"--claims", folder.file("claims.json"), "--analyses",
                             folder.file("analyses.json")});
  write_atomically(folder.file("claims.json"),
                   compact(claims_json(judge_claims(documents))) + "\n");
  write_atomically(folder.file("analyses.json"), compact(analyses_json(results)) + "\n");
  if (!given.no_motion) {
    words.emplace_back("--motion");
    words.push_back(record_into(folder.file("drape"), motion("drape", {{"n", 31}})));
    words.push_back(record_into(folder.file("patch"), motion("patch", {{"n", 25}})));
  }
  const std::filesystem::path out(given.out);
  return draw("report.py", words, out.parent_path().string(), out.filename().string());
}

}  // namespace

Verb report_verb() {
  return {"report",
          "write one page, to open offline: findings, charts, tables, figures, claims, scenes in "
          "motion",
          [](const Command& command) -> Action {
            const auto given = std::make_shared<ReportOptions>();
            command.option("results", given->results, "result files", "RESULT.json ...").required();
            command.option("--answers", given->answers, "results of bench answers",
                           "ANSWERS.json ...");
            command.option("--out", given->out, "the page", "report.html").required();
            command.flag("--no-motion", given->no_motion,
                         "leave out the scenes in motion, which take seconds to simulate");
            return [given] { return report(*given); };
          }};
}

}  // namespace harness
