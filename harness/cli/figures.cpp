#include "harness/cli/figures.h"

#include <sys/wait.h>
#include <unistd.h>

#include <iostream>

#include "harness/analysis/analysis_json.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/cli/exit_codes.h"
#include "harness/points/joined.h"
#include "harness/points/result_file.h"

namespace harness {

namespace {

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
  const nlohmann::json table = read_results(files);
  if (!table.contains("points"))
    throw UsageError("'" + files.front() +
                     "' is no sweep: pieces of sweeps alone are drawn as one");
  const TemporaryFolder folder("pieces");
  write_atomically(folder.file(name + ".json"), table.dump());
  return draw_analysed(folder.file(name + ".json"), analysis::analysis_of(table), more);
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
