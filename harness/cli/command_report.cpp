// Pages and figures of result files: bench report, results and plot.
#include <filesystem>
#include <iostream>
#include <sstream>

#include "harness/analysis/analysis_json.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/claims/claims.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/options.h"
#include "harness/cli/output.h"
#include "harness/cli/verbs.h"
#include "harness/film/recording.h"
#include "harness/points/result_file.h"
#include "harness/points/tuned.h"
#include "harness/tables/results_page.h"

namespace harness {
namespace {

using nlohmann::json;

// What the page says and draws: every file with its analysis, the verdicts on the claims, and the
// findings of all sweeps, those of pieces of one sweep taken together.
json page_json(const std::vector<NamedResult>& files) {
  std::vector<json> documents, sweeps;
  json results = json::array(), claims = results, findings = results;
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
    const json table = joined(sweeps);
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

struct Report {
  Words results, answers;
  std::string out;
  bool no_motion = false;

  void declare(const Command& command) {
    add_results(command, results, "result files");
    command.option("--answers", answers, "results of bench answers", "ANSWERS.json ...");
    command.option("--out", out, "the page", "report.html");
    command.require({"--out"});
    command.flag("--no-motion", no_motion,
                 "leave out the scenes in motion, which take seconds to simulate");
  }

  int run() {
    check_writable(out);
    std::vector<NamedResult> files;
    for (const std::string& file : results)
      files.push_back({file, read_result(file, ResultKinds::all)});
    for (const std::string& file : answers)
      files.push_back({file, read_result(file, ResultKinds::answers)});
    const TemporaryFolder folder("report");
    write_atomically(folder.file("report.json"), page_json(files).dump());
    Words words{folder.file("report.json")};
    if (!no_motion)
      words.insert(words.end(),
                   {"--motion", record_into(folder.file("drape"), motion("drape", {{"n", 31}})),
                    record_into(folder.file("patch"), motion("patch", {{"n", 25}}))});
    const std::filesystem::path place(out);
    return draw("report.py", words, place.parent_path().string(), place.filename().string());
  }
};

struct Results {
  Words results, growth, answers;
  std::string out;

  void declare(const Command& command) {
    add_results(command, results,
                "result files; of points that several have, the first one's count for claims");
    command.option("--growth", growth, "result files for the tables of growth alone",
                   "RESULT.json ...");
    command.option("--answers", answers, "results of bench answers", "ANSWERS.json ...");
    command.option("--out", out, "the page; default: standard output", "FILE");
  }

  // The page begins with the command that makes it again.
  std::string page() const {
    std::ostringstream text;
    text << "# Results\n\nThis page is generated; do not edit it. The command, which gives every "
            "file that the numbers come from:\n\n```sh\n./bench results";
    const auto files = [&text](const char* option, const Words& names) {
      if (!names.empty()) text << option;
      for (const std::string& file : names) text << ' ' << file;
    };
    files("", results);
    files(" --growth", growth);
    files(" --answers", answers);
    if (!out.empty()) text << " --out " << out;
    text << "\n```\n\nTimes are the least of several samples. [measuring.md](measuring.md) says "
            "what they mean, and how far they can be trusted. Ratios have their 95 % interval, "
            "`3.5 (3.3-3.8)`; `3.5 (?)`: it is not known, for too few runs and no A/A pair. "
            "`bench show RESULT.json --all` has every contestant of a file, `bench report` every "
            "run.\n\n";
    std::vector<NamedResult> sweeps, growing, known;
    for (const std::string& file : results) {
      NamedResult result{file, read_result(file, ResultKinds::all)};
      (is_answers(result.document) ? known : sweeps).push_back(std::move(result));
    }
    for (const std::string& file : answers)
      known.push_back({file, read_result(file, ResultKinds::answers)});
    for (const std::string& file : growth) growing.push_back({file, read_result(file)});
    print_results_page(text, sweeps, growing, known);
    return text.str();
  }

  int run() {
    if (!out.empty()) check_writable(out);
    write_atomically(out.empty() ? "-" : out, page());
    return success;
  }
};

struct Plot {
  Words files;
  std::string out, name;

  void declare(const Command& command) {
    add_results(command, files,
                "result file; several: pieces of one sweep, drawn as one, with --name");
    command.option("--out", out, "folder for the figures; default: beside the result", "DIR");
    command.option("--name", name, "of several files: what the pictures' names begin with", "NAME");
  }

  int run() {
    const bool several = files.size() > 1;
    if (several == name.empty())
      throw UsageError(several
                           ? "several result files are drawn as one: give it a --name"
                           : "--name is for several result files; pictures of one have its name");
    return several ? draw_pieces(files, name, out) : draw_result(files.front(), out);
  }
};

}  // namespace

Verb report_verb() {
  return {"report",
          "write one page, to open offline: findings, charts, tables, figures, claims, scenes in "
          "motion",
          verb<Report>};
}

Verb results_verb() {
  return {"results", "write tables of result files in Markdown (docs/results.md)", verb<Results>};
}

Verb plot_verb() {
  return {"plot", "draw the figures of a result file again; of several pieces of one sweep as one",
          verb<Plot>};
}

}  // namespace harness
