#include "harness/cli/commands.h"

#include <sys/wait.h>
#include <unistd.h>

#include <iostream>

#include "harness/base/paths.h"

namespace harness {

void add_no_wait(const Command& to, bool& no_wait) {
  to.flag("--no-wait", no_wait,
          "another program is taking times on this machine: stop instead of waiting for it");
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
