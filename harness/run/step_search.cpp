#include "harness/run/step_search.h"

#include <set>

#include "harness/run/measure_point.h"

namespace harness {
namespace {

// From this ratio of times on, one sample decides. Other programs on the machine can double a short
// run's time.
constexpr double clearly_slower = 1.5, clearly_slower_short = 2.5;
constexpr double close_neighbor = 2;  // times the best time
constexpr double noise = 1.03;        // smaller ratios of times count as equal
// A run that has stepped for this many times the slowest level's best time cannot be the best of
// any level. While errors are still too large, patience suffices for four more halvings.
constexpr double hopeless_factor = 3, patient_factor = 30;
// An error above this fraction of the one at twice the step falls more slowly than first order.
// Cloth may settle into the same wrong folds at several coarse steps before a finer one is right.
constexpr double stays = 0.85;
constexpr int longest_stay = 5;
// Timeouts that end a walk. As some methods iterate longest at coarse steps, one that gets farther
// than the one before by this factor does not count.
constexpr int most_timeouts = 2;
constexpr double farther = 1.1;
constexpr double never = std::numeric_limits<double>::infinity();

// A point whose calibration timed out is skipped.
bool gave_up(const PointResult& point) {
  return point.status == PointStatus::timeout || point.status == PointStatus::skipped;
}

class StepSearch {
 public:
  explicit StepSearch(const StepLadder& ladder) : ladder_(ladder), levels_(ladder.levels) {
    levels_.push_back(any_motion);
  }

  BestSteps run() {
    if (ladder_.every_step)
      try_all();
    else
      find();
    return {best_rung(any_motion), timed_out_ && !unsupported_, std::move(seconds_)};
  }

 private:
  void find() {
    const std::size_t stride = ladder_.stride;
    const std::size_t near = std::min(ladder_.start.value_or(0), ladder_.rungs - 1);
    const std::size_t first = near - near % stride;
    lowest_ = highest_ = first;
    walk(first, +1);
    if (first > 0 && !unsupported_) walk(first - stride, -1);
    look_around_best();
    for (auto next = beyond_best(); next && !unsupported_; next = beyond_best()) {
      walk(next->first, next->second);
      look_around_best();
    }
    refine();
  }

  void try_all() {
    int timeouts = 0;
    for (std::size_t rung = 0; rung < ladder_.rungs && timeouts < most_timeouts; ++rung) {
      const PointResult& point = visit(rung);
      if (unsupported_) break;
      timeouts = gave_up(point) ? timeouts + 1 : 0;
    }
    look_around_best();
  }

  const PointResult& visit(std::size_t rung) {
    const PointResult& point = ladder_.run(rung, ladder_.every_step ? never : longest_useful());
    unsupported_ = point.status == PointStatus::unsupported;
    lowest_ = std::min(lowest_, rung);
    highest_ = std::max(highest_, rung);
    timed_out_ = timed_out_ && gave_up(point);
    if (!point.ok()) return point;
    const double seconds = point.seconds();
    seconds_[any_motion][rung] = seconds;
    for (const double level : ladder_.levels) {
      if (error_at(point.measures, level).samples > 0) goal_ = level;
      if (within_error(point.measures, level)) seconds_[level][rung] = seconds;
    }
    return point;
  }

  void walk(std::size_t from, int direction) {
    int rises = 0, timeouts = 0;
    double last_error = never, reached = never;  // reached: simulated time at the last timeout
    error_stays_ = failures_ = 0;
    for (std::size_t rung = from; rung < ladder_.rungs;
         rung += ladder_.stride * static_cast<std::size_t>(direction)) {  // wraps below 0
      const PointResult& point = visit(rung);
      if (unsupported_) return;
      const bool rose = point.ok() ? slower(rung, any_motion)
                                   : best_rung(any_motion).has_value() || direction < 0;
      if (rose)
        ++rises;
      else if (best_rung(any_motion) == rung)
        rises = 0;
      failures_ = point.ok() ? 0 : failures_ + 1;
      if (gave_up(point)) {
        const double time = static_cast<double>(point.work.steps) * point.spec.step;
        if (!(time > farther * reached)) ++timeouts;
        reached = time;
      }
      if (point.ok() && goal_) {
        const double error = error_at(point.measures, *goal_).distance;
        error_stays_ = error > stays * last_error && error > *goal_ ? error_stays_ + 1 : 0;
        last_error = error;
      }
      if (timeouts >= most_timeouts || (rises >= 2 && (direction < 0 || done(rung, point)))) return;
    }
  }

  // Whether a walk to finer steps ends, after its time has risen twice in a row.
  bool done(std::size_t rung, const PointResult& point) {
    if (!goal_ || error_stays_ >= longest_stay || gave_up(point)) return true;
    if (!point.ok()) return failures_ >= 2;
    return point.seconds() > too_long() || slower(rung, *goal_);
  }

  // Whether a rung that ran to the end is slower than the best one within a level, beyond noise.
  bool slower(std::size_t rung, double level) {
    const auto& all = seconds_.at(any_motion);
    for (auto best = best_rung(level); best && *best != rung; best = best_rung(level)) {
      const PointResult& point = visit(rung);
      const double seconds = all.at(rung) * point.spec.step * point.steps_planned;
      const double decides = seconds < longest_retaken ? clearly_slower_short : clearly_slower;
      if (all.at(rung) > decides * all.at(*best)) return true;
      if (sampled_.contains(rung) && sampled_.contains(*best))
        return all.at(rung) > noise * all.at(*best);
      sample_again(rung);
      sample_again(*best);
    }
    return false;
  }

  void sample_again(std::size_t rung) {
    if (!sampled_.insert(rung).second) return;
    for (std::size_t i = visit(rung).samples.size(); i < samples_when_close; ++i)
      ladder_.again(rung);
    visit(rung);
  }

  // A disturbed first sample may make the best step look slower than its neighbour.
  void look_around_best() {
    if (!best_rung(any_motion)) return;
    const auto& all = seconds_.at(any_motion);
    for (const double level : levels_) {
      for (std::optional<std::size_t> last, best = best_rung(level); best && best != last;
           best = best_rung(level)) {
        last = best;
        for (const std::size_t rung : {*best - ladder_.stride, *best + ladder_.stride}) {
          const auto place = all.find(rung);  // perhaps not tried
          if (place == all.end() || place->second >= close_neighbor * all.at(*best)) continue;
          sample_again(*best);
          sample_again(rung);
        }
      }
    }
  }

  // The next rung and its direction, where a best step is an end of the range tried.
  std::optional<std::pair<std::size_t, int>> beyond_best() const {
    for (const auto& [level, times] : seconds_) {
      const auto best = best_rung(level);
      if (best == highest_ && highest_ + ladder_.stride < ladder_.rungs)
        return std::pair(highest_ + ladder_.stride, +1);
      if (best == lowest_ && lowest_ > 0) return std::pair(lowest_ - ladder_.stride, -1);
    }
    return std::nullopt;
  }

  // Tries rungs beside the best of each level until neither side is faster.
  void refine() {
    if (ladder_.stride == 1 || unsupported_) return;
    std::set<std::size_t> tried;
    for (const double level : levels_)
      for (bool moved = true; moved;) {
        const auto best = best_rung(level);
        if (!best) break;
        for (const std::size_t rung : {*best - 1, *best + 1}) {  // below 0: beyond the last
          if (rung >= ladder_.rungs || seconds_.at(any_motion).contains(rung) ||
              !tried.insert(rung).second)
            continue;
          if (visit(rung).ok()) slower(rung, level);  // samples, if it is close
        }
        moved = best_rung(level) != best;
      }
  }

  double too_long() const {
    auto base = best_seconds(any_motion);
    for (const double level : ladder_.levels)
      if (const auto met = best_seconds(level)) base = met;
    return base ? patient_factor * *base : never;
  }

  double longest_useful() const {
    if (goal_ && !best_seconds(*goal_) && error_stays_ < longest_stay) return too_long();
    double longest = 0;  // of the best steps of all levels that have one
    for (const auto& [level, times] : seconds_) longest = std::max(longest, *best_seconds(level));
    return longest > 0 ? hopeless_factor * longest : never;
  }

  std::optional<std::size_t> best_rung(double level) const {
    const auto within = seconds_.find(level);
    if (within == seconds_.end()) return std::nullopt;
    return std::ranges::min_element(within->second, {}, [](const auto& one) { return one.second; })
        ->first;
  }

  std::optional<double> best_seconds(double level) const {
    const auto best = best_rung(level);
    return best ? std::optional(seconds_.at(level).at(*best)) : std::nullopt;
  }

  const StepLadder& ladder_;
  std::vector<double> levels_;  // any_motion too
  // The finest level at which errors are known; none before the first error, or without one.
  std::optional<double> goal_;
  std::size_t lowest_ = 0, highest_ = 0;  // of the rungs that were tried
  std::set<std::size_t> sampled_;         // rungs that had their samples_when_close
  std::map<double, std::map<std::size_t, double>> seconds_;  // by level and rung
  bool timed_out_ = true;
  bool unsupported_ = false;            // the solver does not take the problem, whatever the step
  int error_stays_ = 0, failures_ = 0;  // of the current walk, in a row
};

}  // namespace

BestSteps find_best_steps(const StepLadder& ladder) { return StepSearch(ladder).run(); }

}  // namespace harness
