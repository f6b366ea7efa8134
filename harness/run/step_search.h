// The search for a solver's best step.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "harness/points/point.h"

namespace harness {

// The step search of docs/measuring.md: from coarse to fine until the time has risen twice in a
// row; with a neighbour's best step, from there in both directions. A failure counts as a rise, and
// before the first success as a reason to go finer. Points that miss max_error count as failures;
// once that error has grown twice in a row towards finer steps (slack within the limit then
// dominates it), finer ones are hopeless.
class StepSearch {
 public:
  using Run = std::function<const PointResult&(std::size_t rung)>;
  StepSearch(std::size_t rungs, Run run, double max_error = std::numeric_limits<double>::infinity())
      : rungs_(rungs), run_(std::move(run)), max_error_(max_error) {}

  // The best rung; none if every step failed.
  // start: the rung to begin from.
  std::optional<std::size_t> find(std::optional<std::size_t> start);

  // Every rung from coarse to fine, until two in a row have timed out; the fastest.
  std::optional<std::size_t> find_among_all();

  // Permissible rungs whose one time is within this factor of the best one's: which of them is the
  // best, more runs must say.
  std::vector<std::size_t> near_best(double factor) const;

  bool timed_out() const { return timed_out_; }

 private:
  double error(const PointResult& point) const;
  bool permissible(const PointResult& point) const;
  static bool gave_up(const PointResult& point);  // for want of time
  bool consider(std::size_t rung, const PointResult& point);
  void walk(std::size_t from, int direction);

  std::size_t rungs_;
  Run run_;
  double max_error_;
  std::optional<std::size_t> best_;
  double best_seconds_ = 0;
  std::map<std::size_t, double> seconds_;  // of permissible rungs
  bool timed_out_ = false;
  bool unsupported_ = false;  // the solver does not take the problem, whatever the step
};

}  // namespace harness
