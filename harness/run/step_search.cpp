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
  const std::size_t near = std::min(start.value_or(0), rungs_ - 1), first = near - near % stride_;
  lowest_ = highest_ = first;
  walk(first, +1);
  if (first > 0 && !unsupported_) walk(first - stride_, -1);
  look_around_best();
  for (auto next = beyond_best(); next && !unsupported_; next = beyond_best()) {
    walk(next->first, next->second);
    look_around_best();
  }
  refine();
  return best_rung(any_motion);
}

// Rungs beside the best of each level, until those on both sides are there and not faster. What has
// failed is a rung that was tried.
void StepSearch::refine() {
  if (stride_ == 1 || unsupported_) return;
  std::set<std::size_t> tried;
  std::vector<double> levels = levels_;
  levels.push_back(any_motion);
  for (const double level : levels) {
    for (bool moved = true; moved;) {
      const auto best = best_rung(level);
      if (!best) break;
      for (const std::size_t rung : {*best - 1, *best + 1}) {  // below 0: beyond the last
        if (rung >= rungs_ || seconds_.at(any_motion).contains(rung) || !tried.insert(rung).second)
          continue;
        consider(rung, run_(rung));
        if (seconds_.at(any_motion).contains(rung)) slower(rung, level);  // samples, if it is close
      }
      moved = best_rung(level) != best;
    }
  }
}

std::optional<std::size_t> StepSearch::find_among_all() {
  int timeouts = 0;
  for (std::size_t rung = 0; rung < rungs_ && timeouts < 2; ++rung) {
    const PointResult& point = run_(rung);
    unsupported_ = point.status == PointStatus::unsupported;
    if (unsupported_) break;
    consider(rung, point);
    timeouts = gave_up(point) ? timeouts + 1 : 0;
  }
  look_around_best();
  return best_rung(any_motion);
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

std::optional<std::size_t> StepSearch::best_rung(double level) const {
  const auto within = seconds_.find(level);
  if (within == seconds_.end()) return std::nullopt;
  return std::min_element(within->second.begin(), within->second.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::optional<double> StepSearch::best_seconds(double level) const {
  const auto best = best_rung(level);
  return best ? std::optional(seconds_.at(level).at(*best)) : std::nullopt;
}

// A point is skipped where its calibration timed out.
bool StepSearch::gave_up(const PointResult& point) {
  return point.status == PointStatus::timeout || point.status == PointStatus::skipped;
}

void StepSearch::consider(std::size_t rung, const PointResult& point) {
  lowest_ = std::min(lowest_, rung);
  highest_ = std::max(highest_, rung);
  timed_out_ = timed_out_ && gave_up(point);
  if (!point.ok()) return;
  const double seconds = point.seconds();
  seconds_[any_motion][rung] = seconds;
  for (const double level : levels_) {
    if (error_at(point.measures, level).samples > 0) goal_ = level;
    if (within_error(point.measures, level)) seconds_[level][rung] = seconds;
  }
}

void StepSearch::sample_again(std::size_t rung) {
  if (!sampled_.insert(rung).second) return;
  const std::size_t samples = run_(rung).samples.size();
  for (std::size_t i = samples; i < samples_when_close; ++i) again_(rung);
  consider(rung, run_(rung));
}

// Whether a rung that ran to the end is slower than the best one within a level, beyond noise.
bool StepSearch::slower(std::size_t rung, double level) {
  const auto& all = seconds_.at(any_motion);
  for (auto best = best_rung(level); best && *best != rung; best = best_rung(level)) {
    if (all.at(rung) > clearly_slower * all.at(*best)) return true;
    if (sampled_.contains(rung) && sampled_.contains(*best))
      return all.at(rung) > noise * all.at(*best);
    sample_again(rung);
    sample_again(*best);
  }
  return false;
}

// Where a first sample was disturbed, the best step may look like its neighbour's rise.
void StepSearch::look_around_best() {
  if (!best_rung(any_motion)) return;
  const auto& all = seconds_.at(any_motion);
  std::vector<double> levels = levels_;
  levels.push_back(any_motion);
  for (const double level : levels) {
    for (std::optional<std::size_t> last, best = best_rung(level); best && best != last;
         best = best_rung(level)) {
      last = best;
      for (const std::size_t rung : {*best - stride_, *best + stride_}) {  // perhaps not tried
        const auto place = all.find(rung);
        if (place == all.end() || place->second >= close_neighbor * all.at(*best)) continue;
        sample_again(*best);
        sample_again(rung);
      }
    }
  }
}

std::optional<std::pair<std::size_t, int>> StepSearch::beyond_best() const {
  for (const auto& [level, times] : seconds_) {
    const auto best = best_rung(level);
    if (best == highest_ && highest_ + stride_ < rungs_) return std::pair(highest_ + stride_, +1);
    if (best == lowest_ && lowest_ > 0) return std::pair(lowest_ - stride_, -1);
  }
  return std::nullopt;
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

// Whether a walk to finer steps has ended whose time has risen twice in a row.
bool StepSearch::done(std::size_t rung, const PointResult& point) {
  if (!goal_ || error_stays_ >= 2 || gave_up(point)) return true;
  if (!point.ok()) return failures_ >= 2;
  return point.seconds() > tenfold() || slower(rung, *goal_);
}

void StepSearch::walk(std::size_t from, int direction) {
  int rises = 0, timeouts = 0;
  double last_error = std::numeric_limits<double>::infinity();
  error_stays_ = failures_ = 0;
  for (std::size_t rung = from; rung < rungs_;
       rung += stride_ * static_cast<std::size_t>(direction)) {  // wraps below 0
    const PointResult& point = run_(rung);
    unsupported_ = point.status == PointStatus::unsupported;
    if (unsupported_) return;
    consider(rung, point);
    const bool rose =
        point.ok() ? slower(rung, any_motion) : best_rung(any_motion).has_value() || direction < 0;
    if (rose) {
      ++rises;
    } else if (best_rung(any_motion) == rung) {
      rises = 0;
    }
    failures_ = point.ok() ? 0 : failures_ + 1;
    if (gave_up(point)) ++timeouts;
    if (point.ok() && goal_) {
      const double error = error_at(point.measures, *goal_).distance;
      error_stays_ = error > stays * last_error && error > *goal_ ? error_stays_ + 1 : 0;
      last_error = error;
    }
    if (timeouts == 2 || (rises >= 2 && (direction < 0 || done(rung, point)))) return;
  }
}

}  // namespace harness
