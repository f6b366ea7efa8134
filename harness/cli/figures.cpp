#include "harness/cli/figures.h"

#include <filesystem>
#include <iostream>
#include <limits>
#include <set>

#include "harness/analysis/analysis_json.h"
#include "harness/base/child_program.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/claims/claims.h"
#include "harness/cli/exit_codes.h"
#include "harness/points/result_file.h"

namespace harness {

namespace fs = std::filesystem;

int draw(const std::string& script, const std::vector<std::string>& arguments,
         const std::string& folder, const std::string& name) {
  const TemporaryFolder scratch("draw");
  std::vector<std::string> words{"/usr/bin/python3", source_path("plots/" + script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  words.insert(words.end(), {"--out", name.empty() ? scratch.path() : scratch.file(name)});
  const ProgramResult ran =
      run_program(words, "", std::numeric_limits<double>::infinity(), interrupted);
  if (interrupted()) throw Interrupted();
  std::cerr << ran.err;
  if (ran.exit_code == 127)
    std::cerr << "bench: figures need /usr/bin/python3 with matplotlib (Debian: "
                 "python3-matplotlib)\n";
  if (ran.exit_code != 0) return ran.exit_code;
  std::set<fs::path> drawn;
  for (const auto& entry : fs::directory_iterator(scratch.path())) drawn.insert(entry.path());
  const fs::path to = folder.empty() ? fs::path(".") : fs::path(folder);
  std::error_code error;
  fs::create_directories(to, error);
  for (const fs::path& file : drawn) {
    const std::string place = (to / file.filename()).lexically_normal().string();
    write_atomically(place, read_file(file.string(), "drawing"));
    std::cout << place << std::endl;
  }
  return success;
}

nlohmann::json with_analysis(nlohmann::json document) {
  if (document.contains("points")) {
    check_timed(document);
    document["analysis"] = analysis::analysis_of(document);
  }
  return document;
}

namespace {

// Pictures whose names begin with `name`.
int draw_document(nlohmann::json document, const std::string& name, const std::string& folder) {
  const TemporaryFolder scratch("figures");
  write_atomically(scratch.file(name + ".json"), with_analysis(std::move(document)).dump());
  return draw("figures.py", {scratch.file(name + ".json")}, folder);
}

}  // namespace

int draw_pieces(const std::vector<std::string>& files, const std::string& name,
                std::string folder) {
  if (folder.empty()) folder = fs::path(files.front()).parent_path().string();
  nlohmann::json table = read_results(files);
  if (!table.contains("points"))
    throw UsageError("'" + files.front() +
                     "' is no sweep: pieces of sweeps alone are drawn as one");
  return draw_document(std::move(table), name, folder);
}

int draw_result(const std::string& file, std::string folder) {
  const fs::path path(file);
  if (folder.empty()) folder = path.parent_path().string();
  return draw_document(read_result_or_answers(file), path.stem().string(), folder);
}

}  // namespace harness
