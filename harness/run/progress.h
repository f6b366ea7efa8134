// What a person sees while a sweep runs.
#pragma once

#include <chrono>
#include <ostream>

#include "harness/points/point.h"

namespace harness {

class Progress {
 public:
  // terminal: one line that is rewritten, as wide as the terminal; otherwise one line a point.
  Progress(std::ostream& out, bool terminal);
  void point(const PointResult& point, std::size_t search, std::size_t searches);
  void repetition(std::size_t done, std::size_t all);
  void finish();

 private:
  // `begin`: of what the fraction is of.
  void bar(double fraction, std::chrono::steady_clock::time_point begin, const std::string& head,
           const std::string& text);

  std::ostream& out_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point repeating_since_ = {};
  std::size_t points_ = 0;
  std::size_t width_ = 0;
};

}  // namespace harness
