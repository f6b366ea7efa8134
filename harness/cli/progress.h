// What a person sees while a sweep runs.
#pragma once

#include <chrono>
#include <ostream>

#include "harness/points/point.h"

namespace harness {

class Progress {
 public:
  // terminal: one line that is rewritten, as wide as the terminal; otherwise, for logs, some forty
  // lines in all, with the time that is left. Why a point failed stands in the result.
  Progress(std::ostream& out, bool terminal);
  void point(const PointResult& point, std::size_t search, std::size_t searches);
  void repetition(std::size_t done, std::size_t all);
  void finish();

 private:
  // `begin`: of what the fraction is of.
  void bar(double fraction, std::chrono::steady_clock::time_point begin, const std::string& head,
           const std::string& text);

  // "120 points, 2 min 5 s, about 4 min left".
  std::string state(double fraction, std::chrono::steady_clock::time_point begin,
                    const std::string& head) const;
  // Whether this much done is worth a line of a log.
  bool worth_a_line(double fraction);

  std::ostream& out_;
  bool terminal_;
  int lines_ = 0;  // of the log, in this part
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point repeating_since_ = {};
  std::size_t points_ = 0;
  std::size_t width_ = 0;
};

}  // namespace harness
