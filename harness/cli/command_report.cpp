// bench report: one page that tells what result files found.
#include <filesystem>

#include "harness/analysis/analysis_json.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/claims/claims.h"
#include "harness/cli/figures.h"
#include "harness/cli/verbs.h"
#include "harness/film/recording.h"
#include "harness/points/joined.h"
#include "harness/points/result_file.h"
#include "harness/points/tuned.h"

namespace harness {
namespace {

// What the page says and draws: every file with its analysis, the verdicts on the claims, and the
// findings of all sweeps, those of pieces of one sweep taken together.
nlohmann::json page_json(const std::vector<NamedResult>& files) {
  std::vector<nlohmann::json> documents, sweeps;
  nlohmann::json results = nlohmann::json::array(), claims = results, findings = results;
  for (const auto& [name, document] : files) {
    if (!is_answers(document)) documents.push_back(document);
    if (document.contains("points")) sweeps.push_back(document);
    results.push_back({{"name", name}, {"document", with_analysis(document)}});
  }
  for (const ClaimVerdict& claim : judge_claims(documents))
    claims.push_back({{"id", claim.id},
                      {"statement", claim.statement},
                      {"verdict", claim.verdict},
                      {"measured", claim.measured},
                      {"rule", claim.rule}});
  if (!sweeps.empty()) {
    const nlohmann::json table = joined(sweeps);
    findings = analysis::findings_json(analysis::planes_of(table));
  }
  return {{"results", std::move(results)},
          {"findings", std::move(findings)},
          {"claims", std::move(claims)}};
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
  std::vector<NamedResult> files;
  for (const std::string& file : given.results)
    files.push_back({file, read_result_or_answers(file)});
  for (const std::string& file : given.answers) files.push_back({file, read_answers(file)});
  const TemporaryFolder folder("report");
  write_atomically(folder.file("report.json"), page_json(files).dump());
  std::vector<std::string> words{folder.file("report.json")};
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
