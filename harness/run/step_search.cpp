#include "harness/run/step_search.h"

#include <algorithm>
#include <cmath>

namespace harness {

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

std::vector<std::size_t> StepSearch::near_best(double factor) const {
  std::vector<std::size_t> rungs;
  for (const auto& [rung, seconds] : seconds_) {
    if (seconds <= factor * best_seconds_) rungs.push_back(rung);
  }
  return rungs;
}

double StepSearch::error(const PointResult& point) const {
  return error_at(point.measures, max_error_).distance;
}

bool StepSearch::permissible(const PointResult& point) const {
  return point.ok() && within_error(point.measures, max_error_);
}

// A point is skipped where its calibration timed out.
bool StepSearch::gave_up(const PointResult& point) {
  return point.status == PointStatus::timeout || point.status == PointStatus::skipped;
}

bool StepSearch::consider(std::size_t rung, const PointResult& point) {
  if (!permissible(point)) return false;
  seconds_[rung] = point.median_seconds();
  if (best_ && point.median_seconds() >= best_seconds_) return false;
  best_ = rung;
  best_seconds_ = point.median_seconds();
  return true;
}

void StepSearch::walk(std::size_t from, int direction) {
  int rises = 0, timeouts = 0, error_rises = 0;
  double last_error = std::numeric_limits<double>::infinity();
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
    if (gave_up(point)) {
      timed_out_ = true;
      ++timeouts;
    }
    if (point.ok() && !permissible(point)) {
      error_rises = error(point) > last_error ? error_rises + 1 : 0;
      last_error = error(point);
    }
    if (rises == 2 || timeouts == 2 || error_rises == 2) return;
  }
}

}  // namespace harness
