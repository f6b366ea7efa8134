#include "harness/run/step_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace harness {
namespace {

// A run that has stepped for this many times the best one's time cannot be the best; its time has
// risen. While errors are too large yet, ten times.
constexpr double hopeless_factor = 3, patient_factor = 10;
// An error above this part of the one at twice the step does not fall as a method of first order's.
constexpr double stays = 0.85;

}  // namespace

std::optional<std::size_t> StepSearch::find(std::optional<std::size_t> start) {
  const std::size_t first = std::min(start.value_or(0), rungs_ - 1);
  walk(first, +1);
  if (first > 0 && !unsupported_) walk(first - 1, -1);
  return best_;
}

std::optional<std::size_t> StepSearch::find_among_all() {
  int timeouts = 0;
  for (std::size_t rung = 0; rung < rungs_ && timeouts < 2; ++rung) {
    const PointResult& point = run_(rung);
    if (point.status == PointStatus::unsupported) break;
    consider(rung, point);
    timeouts = gave_up(point) ? timeouts + 1 : 0;
  }
  return best_;
}

std::vector<std::size_t> StepSearch::near_best(double level, double factor) const {
  std::vector<std::size_t> rungs;
  const auto best = best_seconds(level);
  if (!best) return rungs;
  for (const auto& [rung, seconds] : seconds_.at(level)) {
    if (seconds <= factor * *best) rungs.push_back(rung);
  }
  return rungs;
}

std::optional<double> StepSearch::best_seconds(double level) const {
  const auto within = seconds_.find(level);
  if (within == seconds_.end()) return std::nullopt;
  const auto best =
      std::min_element(within->second.begin(), within->second.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return best->second;
}

// A point is skipped where its calibration timed out.
bool StepSearch::gave_up(const PointResult& point) {
  return point.status == PointStatus::timeout || point.status == PointStatus::skipped;
}

// Whether it is the fastest so far.
bool StepSearch::consider(std::size_t rung, const PointResult& point) {
  if (!point.ok()) return false;
  const double seconds = point.median_seconds();
  const auto fastest = best_seconds(any_motion);
  seconds_[any_motion][rung] = seconds;
  for (const double level : levels_) {
    if (error_at(point.measures, level).samples > 0) goal_ = level;
    if (within_error(point.measures, level)) seconds_[level][rung] = seconds;
  }
  if (fastest && seconds >= *fastest) return false;
  best_ = rung;
  return true;
}

double StepSearch::tenfold() const {
  auto base = best_seconds(any_motion);
  for (const double level : levels_) {
    if (const auto met = best_seconds(level)) base = met;
  }
  return base ? patient_factor * *base : std::numeric_limits<double>::infinity();
}

double StepSearch::longest_useful() const {
  if (wants_less_error()) return tenfold();
  const auto fastest = best_seconds(any_motion);
  return fastest ? hopeless_factor * *fastest : std::numeric_limits<double>::infinity();
}

// Of a walk to finer steps whose time has risen twice in a row.
bool StepSearch::done(const PointResult& point) const {
  if (!goal_ || error_stays_ >= 2 || gave_up(point)) return true;
  if (!point.ok()) return failures_ >= 2;
  if (point.median_seconds() > tenfold()) return true;
  const auto met = best_seconds(*goal_);
  return met && point.median_seconds() > *met;
}

void StepSearch::walk(std::size_t from, int direction) {
  int rises = 0, timeouts = 0;
  double last_error = std::numeric_limits<double>::infinity();
  error_stays_ = failures_ = 0;
  for (std::size_t rung = from; rung < rungs_;
       rung += static_cast<std::size_t>(direction)) {  // wraps below 0
    const PointResult& point = run_(rung);
    unsupported_ = point.status == PointStatus::unsupported;
    if (unsupported_) return;
    if (consider(rung, point)) {
      rises = 0;
    } else if (best_ || direction < 0) {
      ++rises;
    }
    failures_ = point.ok() ? 0 : failures_ + 1;
    if (gave_up(point)) {
      timed_out_ = true;
      ++timeouts;
    }
    if (point.ok() && goal_) {
      const double error = error_at(point.measures, *goal_).distance;
      error_stays_ = error > stays * last_error && error > *goal_ ? error_stays_ + 1 : 0;
      last_error = error;
    }
    if (timeouts == 2 || (rises >= 2 && (direction < 0 || done(point)))) return;
  }
}

}  // namespace harness
