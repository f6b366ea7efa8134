#include "harness/cli/figures.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "harness/analysis/analysis_json.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/base/temporary_folder.h"
#include "harness/cli/exit_codes.h"
#include "harness/points/result_file.h"

namespace harness {

namespace {

nlohmann::json read_sweep(const std::string& file) {
  nlohmann::json document = parse_document(read_file(file, "result file"), file);
  if (!document.is_object() || document.value("schema", nlohmann::json()) != "inextensible-bench/1")
    throw UsageError("'" + file + "' is no sweep: pieces of sweeps alone are drawn as one");
  check_result(document, file);
  return document;
}

// Whether the point is of the second of an A/A pair, which is no curve of its own. Older files have
// no pair, and points without a contestant.
bool runs_again(const nlohmann::json& point, const nlohmann::json& piece) {
  const auto pair = nlohmann::json::json_pointer("/context/noise/pair/1");
  return piece.contains(pair) && point.contains("contestant") &&
         point.at("contestant") == piece.at(pair);
}

// Those that `all` does not name yet: pieces may have other contestants, and plug-ins of their own.
void add_solvers(nlohmann::json& all, const nlohmann::json& more) {
  for (const nlohmann::json& solver : more) {
    const auto same = [&solver](const nlohmann::json& s) {
      return s.at("name") == solver.at("name");
    };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(solver);
  }
}

int draw_analysed(const std::string& file, const nlohmann::json& analysis,
                  const std::vector<std::string>& more) {
  const TemporaryFolder folder("analysis");
  write_atomically(folder.file("analysis.json"), analysis.dump());
  std::vector<std::string> arguments{file};
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.insert(arguments.end(), {"--analysis", folder.file("analysis.json")});
  return draw(arguments);
}

}  // namespace

int draw_pieces(const std::vector<std::string>& files, const std::string& name,
                const std::vector<std::string>& more) {
  std::vector<nlohmann::json> pieces;
  pieces.reserve(files.size());
  for (const std::string& file : files) pieces.push_back(read_sweep(file));
  std::vector<analysis::Plane> planes;
  std::vector<const nlohmann::json*> documents;
  nlohmann::json all = pieces.front();
  all["points"].clear();
  double noise = std::nan("");
  for (const nlohmann::json& piece : pieces) {
    documents.push_back(&piece);
    add_solvers(all["legend"]["solvers"], piece.at("legend").at("solvers"));
    for (const nlohmann::json& point : piece.at("points")) {
      if (!runs_again(point, piece)) all["points"].push_back(point);
    }
    for (analysis::Plane& plane : analysis::planes_of(piece)) planes.push_back(std::move(plane));
    noise = std::fmax(noise, analysis::pair_noise_of(piece));
  }
  if (std::isfinite(noise)) all["context"]["noise"]["q95"] = noise;
  const TemporaryFolder folder("pieces");
  write_atomically(folder.file(name + ".json"), all.dump());
  return draw_analysed(folder.file(name + ".json"),
                       analysis::analysis_of(analysis::merged(planes), documents), more);
}

int draw_result(const std::string& file, const std::vector<std::string>& more) {
  const nlohmann::json document = parse_document(read_file(file, "result file"), file);
  if (!document.is_object() ||
      document.value("schema", nlohmann::json()) != "inextensible-bench/1") {
    std::vector<std::string> arguments{file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return draw(arguments);
  }
  check_result(document, file);
  return draw_analysed(file, analysis::analysis_of(document), more);
}

int draw(const std::vector<std::string>& arguments, const std::string& script) {
  std::cout.flush();
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> argv;
    std::vector<std::string> words{"/usr/bin/python3", source_path("plots/" + script)};
    words.insert(words.end(), arguments.begin(), arguments.end());
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0) return internal_error;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : internal_error;
  if (code == 127)
    std::cerr << "bench: figures need /usr/bin/python3 with matplotlib (Debian: "
                 "python3-matplotlib)\n";
  return code;
}

}  // namespace harness
