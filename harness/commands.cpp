#include "commands.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iostream>

#include "build_info.h"  // made by CMake

namespace harness {
namespace {

volatile std::sig_atomic_t interrupt_requested = 0;

// The share folder beside an installed program, "" for one in a build folder.
const std::string& share_folder() {
  static const std::string folder = [] {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path share =
        (program.parent_path() / INEXTENSIBLE_DATA_FROM_PROGRAM).lexically_normal();
    return !error && fs::is_directory(share / "configs", error) ? share.string() : std::string();
  }();
  return folder;
}

}  // namespace

std::string source_path(const std::string& relative) {
  return (share_folder().empty() ? INEXTENSIBLE_SOURCE_DIR : share_folder()) + "/" + relative;
}

std::string local_result(const std::string& name) {
  const std::string path = "results/local/" + name;
  return share_folder().empty() ? source_path(path) : path;
}

void catch_interrupts() {
  std::signal(SIGINT, [](int) { interrupt_requested = 1; });
  std::signal(SIGTERM, [](int) { interrupt_requested = 1; });
}

bool interrupted() { return interrupt_requested != 0; }

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
  return WIFEXITED(status) ? WEXITSTATUS(status) : internal_error;
}

}  // namespace harness
