// Another program, run to its end.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace harness {

struct ProgramResult {
  int exit_code = 0;  // 128 + the signal's number if one ended it
  bool timed_out = false;
  std::string out, err;  // what it wrote

  std::string last_error_line() const;  // of err, or how it ended
};

// words: the program's path, then its arguments. It ends with this process at the latest. After
// `timeout` s of wall time, or as soon as `interrupted` says so, it is killed. Throws
// std::runtime_error if no process can be made.
ProgramResult run_program(const std::vector<std::string>& words, const std::string& input,
                          double timeout, const std::function<bool()>& interrupted);

}  // namespace harness
