// The search for a solver's best steps.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "harness/points/point.h"

namespace harness {

// The step search of docs/measuring.md, for the fastest step of any motion and for those within
// levels of error. From coarse to fine until the time has risen twice in a row, and on until
//  - the finest level is met and the next step takes longer, or
//  - time has risen tenfold above the fastest within the tightest level met so far (a fast run with
//    a wrong motion ends no search), or
//  - the error has fallen by less than 15 % twice in a row: slack within the strain limit then
//    dominates it, or
//  - two steps in a row have failed.
// With a neighbour's best step, from there in both directions. A failure counts as a rise, and
// before the first success as a reason to go finer.
//
// A time has risen only if it is more than clearly_slower times the best one's, or if both have
// three samples and it is still more than noise above. At the end the steps next to the best ones
// get three samples, too, unless they are close_neighbor times slower; and where a best step is an
// end of what was tried, though the ladder goes on, the search goes on from there.
//
// All that is on every stride-th rung, which halve the step. Then the best of any motion and of
// each level are refined: by the rungs between, one after the other, as long as these are faster.
class StepSearch {
 public:
  using Run = std::function<const PointResult&(std::size_t rung)>;
  static constexpr double clearly_slower = 1.5;
  static constexpr double close_neighbor = 2;  // less than that many times slower than the best
  static constexpr double noise = 1.03;        // a ratio of times up to this is none
  static constexpr std::size_t samples_when_close = 3;

  // stride: of the rungs that halve the step. run: the rung's point, which is run when it is first
  // asked for. again: the same with one sample more, if it can have one. levels: of error, loose to
  // tight; none: any motion alone.
  StepSearch(std::size_t rungs, Run run, Run again, std::vector<double> levels = {},
             std::size_t stride = 1)
      : rungs_(rungs),
        stride_(stride),
        run_(std::move(run)),
        again_(std::move(again)),
        levels_(std::move(levels)) {}

  // The best rung of any motion; none if every step failed.
  // start: the rung to begin from.
  std::optional<std::size_t> find(std::optional<std::size_t> start);

  // Every rung from coarse to fine, until two in a row have timed out; the fastest.
  std::optional<std::size_t> find_among_all();

  // Rungs within a level (any_motion: all that ran to the end) whose time is within this factor of
  // the best one's: which of them is the best, more samples must say.
  std::vector<std::size_t> near_best(double level, double factor) const;

  // Whether every step that was tried was stopped by its time-out.
  bool timed_out() const { return timed_out_ && !unsupported_; }
  // Seconds per simulated second: a run that takes longer is of no use to the search.
  double longest_useful() const;

 private:
  static bool gave_up(const PointResult& point);  // stopped by its time-out
  void consider(std::size_t rung, const PointResult& point);
  bool slower(std::size_t rung, double level);
  void sample_again(std::size_t rung);
  void look_around_best();
  void refine();
  // Where a best step is an end of what was tried: the next rung, and in which direction it lies.
  std::optional<std::pair<std::size_t, int>> beyond_best() const;
  bool wants_less_error() const { return goal_ && !best_seconds(*goal_) && error_stays_ < 2; }
  double tenfold() const;
  bool done(std::size_t rung, const PointResult& point);
  void walk(std::size_t from, int direction);
  std::optional<std::size_t> best_rung(double level) const;
  std::optional<double> best_seconds(double level) const;

  std::size_t rungs_, stride_;
  Run run_, again_;
  std::vector<double> levels_;
  // The finest level at which errors are known; none before the first error, or without one.
  std::optional<double> goal_;
  std::size_t lowest_ = 0, highest_ = 0;  // of the rungs that were tried
  std::set<std::size_t> sampled_;         // rungs that had their samples_when_close
  std::map<double, std::map<std::size_t, double>> seconds_;  // by level and rung
  bool timed_out_ = true;
  bool unsupported_ = false;            // the solver does not take the problem, whatever the step
  int error_stays_ = 0, failures_ = 0;  // of the current walk, in a row
};

}  // namespace harness
