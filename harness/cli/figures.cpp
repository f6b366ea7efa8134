#include "harness/cli/figures.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <set>

#include "harness/analysis/analysis_json.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/paths.h"
#include "harness/claims/claims.h"
#include "harness/cli/exit_codes.h"
#include "harness/points/joined.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

namespace fs = std::filesystem;

// Its exit code. What it prints on stdout goes nowhere.
int run_script(const std::string& script, const std::vector<std::string>& arguments) {
  std::cout.flush();
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    std::vector<std::string> words{"/usr/bin/python3", source_path("plots/" + script)};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
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

// Pictures whose names begin with `name`.
int draw_document(nlohmann::json document, const std::string& name, const std::string& folder) {
  const TemporaryFolder scratch("figures");
  write_atomically(scratch.file(name + ".json"), with_analysis(std::move(document)).dump());
  return draw("figures.py", {scratch.file(name + ".json")}, folder);
}

}  // namespace

nlohmann::json with_analysis(nlohmann::json document) {
  if (document.contains("points")) {
    check_timed(document);
    document["analysis"] = analysis::analysis_of(document);
  }
  return document;
}

int draw(const std::string& script, std::vector<std::string> arguments, const std::string& folder,
         const std::string& name) {
  const TemporaryFolder scratch("draw");
  arguments.insert(arguments.end(), {"--out", name.empty() ? scratch.path() : scratch.file(name)});
  if (const int code = run_script(script, arguments); code != 0) return code;
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

int draw_pieces(const std::vector<std::string>& files, const std::string& name,
                const std::string& folder) {
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
