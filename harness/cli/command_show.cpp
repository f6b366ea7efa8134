// bench show, claims, results, report and plot: result files printed and drawn.
#include "harness/answers/answer.h"
#include "harness/claims/claims.h"
#include "harness/cli/command.h"
#include "harness/tables/tables.h"

namespace harness {
namespace {

// Throws UsageError for results of --untimed: what is made of these ranks times.
std::vector<NamedResult> read_all(const Words& files, ResultKinds kinds) {
  std::vector<NamedResult> results;
  for (const std::string& file : files) {
    results.push_back({file, read_result(file, kinds)});
    check_timed(results.back().document, "'" + file + "'");
  }
  return results;
}

std::vector<json> documents_of(const std::vector<NamedResult>& files, bool (*wanted)(const json&)) {
  std::vector<json> documents;
  for (const NamedResult& file : files)
    if (wanted(file.document)) documents.push_back(file.document);
  return documents;
}

bool is_of_runs(const json& document) { return !is_answers(document); }

// Several files become one table; a file of known answers cannot be joined with others.
json read_as_one(const Words& files) {
  return files.size() == 1 ? read_result(files.front(), ResultKinds::all) : read_results(files);
}

std::string head_of(const json& document, const std::string& file) {
  const json& context = document.at("context");
  const json& build = context.at("build");
  std::ostringstream out;
  out << file << ": " << context.at("date").get<std::string>() << " on "
      << context.at("cpu_model").get<std::string>() << ", commit "
      << build.at("git").get<std::string>().substr(0, 12)
      << (build.value("dirty", false) ? " with changes" : "") << ", "
      << build.at("compiler").get<std::string>() << '\n';
  if (!document.value("complete", true)) out << "not complete: a run was interrupted\n";
  if (!is_timed(document)) out << "made with --untimed: its times mean nothing\n";
  return out.str();
}

struct Show {
  Words files;
  bool as_json = false, all = false;
  double frame = 0;  // ms; 0: any

  void declare(const Command& command) {
    add_results(command, files, "result files; several count as one");
    command.flag("--json", as_json,
                 "as JSON: which contestant is fastest within each strain limit and error");
    command.flag("--all", all, "every contestant, and how runs failed");
    command.option("--frame", frame,
                   "only runs of which 99 % of the frames of 1/60 s take at most so many ms", "MS",
                   Bounds::positive());
  }

  // What remains was measured within the frame budget.
  void keep_frames(json& document) const {
    json kept = json::array();
    for (const json& point : document.value("points", json())) {
      const auto frames = samples_of(point).frame_times;
      if (std::ranges::any_of(frames, [this](const FrameTime& at) {
            return at.rate == frame_rates.back() && at.slow <= 1e-3 * frame;
          }))
        kept.push_back(point);
    }
    if (kept.empty())
      throw UsageError("'" + files.front() + "' has no run with frames of at most " +
                       number_text(frame) + " ms; runs of less than a second have none");
    document["points"] = kept;
  }

  int run() {
    if (as_json && all) throw UsageError("--json has all contestants already: leave out --all");
    json document = read_as_one(files);
    if (frame > 0) keep_frames(document);
    const std::string& name = files.front();
    if (as_json) {
      if (!is_sweep(document))
        throw UsageError("'" + name +
                         "' has no strain limits and errors to be analyzed; --json is for sweeps "
                         "over strain, resolution and step");
      check_timed(document, "'" + name + "'");
      std::cout << analysis::analysis_of(document).dump(1) << '\n';
      return success;
    }
    std::cout << fitted(head_of(document, name), output_columns())
              << text_of_result(document, name, all);
    return success;
  }
};

struct Claims {
  Words files;

  void declare(const Command& command) { add_results(command, files, "result files"); }

  int run() {
    const auto results = documents_of(read_all(files, ResultKinds::all), is_of_runs);
    if (results.empty()) throw UsageError("claims are about sweeps; results/*.json has some");
    const std::vector<ClaimVerdict> verdicts = judge_claims(results);
    if (std::ranges::all_of(verdicts, [](const ClaimVerdict& claim) {
          return claim.verdict == std::string_view(claims::not_measured);
        }))
      throw UsageError("nothing in '" + files.front() +
                       "' is what a claim is about; results/*.json are");
    print_claims(std::cout, verdicts);
    return success;
  }
};

// Options of results and report: result files, with those of known answers apart.
struct PageOptions {
  Words results, answers;
  std::string out;

  void declare(const Command& command, const std::string& about_results, const std::string& about) {
    add_results(command, results, about_results);
    command.option("--answers", answers, "results of bench answers", "ANSWERS.json ...");
    command.option("--out", out, about, "FILE");
  }

  std::vector<NamedResult> files() const {
    std::vector<NamedResult> all = read_all(results, ResultKinds::all);
    for (NamedResult& known : read_all(answers, ResultKinds::answers))
      all.push_back(std::move(known));
    return all;
  }
};

struct Results : PageOptions {
  void declare(const Command& command) {
    PageOptions::declare(
        command, "result files; of points that several have, the first one's count for claims",
        "the page; default: standard output");
  }

  // The page begins with the command that generates it.
  std::string page() const {
    std::ostringstream text;
    text << "# Results\n\nTimes are the least of several samples. [measuring.md](measuring.md) "
            "says what they mean, and how far they can be trusted. Ratios have their 95 % "
            "interval, `3.5 (3.3-3.8)`; `3.5 (?)`: it is not known, for too few runs and no A/A "
            "pair. `bench show RESULT.json --all` has every contestant of a file, `bench report` "
            "every run. This page is generated; do not edit it. The command, which gives every "
            "file that the numbers come from:\n\n```sh\n./bench results";
    for (const auto& [option, names] : {std::pair("", &results), {" --answers", &answers}}) {
      if (!names->empty()) text << option;
      for (const std::string& file : *names) text << ' ' << file;
    }
    if (!out.empty()) text << " --out " << out;
    text << "\n```\n\n";
    std::vector<NamedResult> sweeps, known;
    for (NamedResult& file : files())
      (is_answers(file.document) ? known : sweeps).push_back(std::move(file));
    print_results_page(text, sweeps, known);
    return text.str();
  }

  int run() {
    if (!out.empty()) check_writable(out);
    write_atomically(out.empty() ? "-" : out, page());
    return success;
  }
};

// What a sweep is of, but for strain limits: scenes with their parameters.
json places_of(const json& document) {
  json places = json::object();
  for (const json& point : document.value("points", json::array()))
    places[json{point.at("scene"), point.at("sweep"), point.at("scene_parameters")}.dump()] = true;
  return places;
}

// Content of the report: every file; sweeps with their analysis, of which files that are of the
// same scenes are pieces; the findings of all; and the verdicts on the claims.
json report_json(const std::vector<NamedResult>& files) {
  json results = json::array(), sweeps = results, findings = results;
  std::map<json, std::vector<std::size_t>> pieces;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto& [name, document] = files[i];
    results.push_back({{"name", name}, {"document", document}});
    json places = places_of(document);
    if (places.empty()) places[name] = true;  // hard cases, known answers
    pieces[places].push_back(i);
  }
  for (const auto& [places, numbers] : pieces) {
    std::vector<json> documents;
    documents.reserve(numbers.size());
    for (const std::size_t i : numbers) documents.push_back(files[i].document);
    sweeps.push_back({{"files", numbers}, {"document", with_analysis(joined(documents))}});
  }
  if (const auto all = documents_of(files, is_sweep); !all.empty())
    findings = analysis::findings_of(analysis::planes_of(joined(all)));
  return {{"results", std::move(results)},
          {"sweeps", std::move(sweeps)},
          {"findings", std::move(findings)},
          {"claims", judge_claims(documents_of(files, is_of_runs))}};
}

struct Report : PageOptions {
  void declare(const Command& command) {
    PageOptions::declare(command, "result files", "the page, report.html");
    command.require({"--out"});
  }

  int run() {
    check_writable(out);
    const TemporaryFolder folder("report");
    write_atomically(folder.file("report.json"), report_json(files()).dump());
    return draw("report.py", {folder.file("report.json")}, out);
  }
};

struct Plot {
  Words files;
  std::string out, name;
  bool all = false;

  void declare(const Command& command) {
    add_results(command, files, "result file; several: pieces of one sweep, drawn as one");
    command.option("--out", out, "folder for the figures; default: beside the result", "DIR");
    command.option("--name", name,
                   "what the pictures' names begin with; default: the result's name", "NAME");
    command.flag("--all", all, "also the complete figures: every solver, its steps and failures");
  }

  int run() {
    const std::filesystem::path first(files.front());
    return draw_figures(read_as_one(files), name.empty() ? first.stem().string() : name,
                        out.empty() ? first.parent_path().string() : out, all);
  }
};

}  // namespace

Action show_verb(const Command& command) { return verb<Show>(command); }
Action claims_verb(const Command& command) { return verb<Claims>(command); }
Action results_verb(const Command& command) { return verb<Results>(command); }
Action report_verb(const Command& command) { return verb<Report>(command); }
Action plot_verb(const Command& command) { return verb<Plot>(command); }

}  // namespace harness
