// What a person sees in the terminal: progress while a sweep runs (stderr), a table at its end
// (stdout).
#pragma once

#include <chrono>
#include <ostream>
#include <vector>

#include "harness/base/fit.h"
#include "harness/run/sweep.h"

namespace harness {

class Progress {
 public:
  // terminal: one line that is rewritten; otherwise one line a point.
  Progress(std::ostream& out, bool terminal);
  void point(const PointResult& point, std::size_t search, std::size_t searches);
  void repetition(std::size_t done, std::size_t all);
  void finish();

 private:
  void bar(double fraction, const std::string& text);

  std::ostream& out_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t points_ = 0;
  std::size_t width_ = 0;
};

// Per scene and sweep: solvers by limit or resolution, best seconds per simulated second and its
// step, a second time within the suite's error limit if there was one; of a step sweep, the time to
// reach each of some errors; failures by name.
void print_table(std::ostream& out, const std::vector<PointResult>& points);

// How the time of a step grows with the vertices: of the best points of one solver in a resolution
// sweep.
struct Growth {
  std::string solver;
  Slope exponent;
  const PointResult *smallest, *largest;  // of those that count
};
// One for each solver with best points at two sizes at least, in the order of `points`, which are
// those of one sweep.
std::vector<Growth> growths(const std::vector<const PointResult*>& points);

// How good a reference is, and where the scene's last vertex is.
void print_reference(std::ostream& out, const Reference& reference);

}  // namespace harness
