#include "harness/run/choose.h"

#include <numeric>

namespace harness {
namespace {

constexpr double screening_share = 0.25;  // of the time, at most
constexpr double search_share = 0.75;     // of the time, screening included; then come finalists
constexpr std::size_t finalists = 4;
constexpr std::size_t final_samples = 7;  // of each

bool within(const PointResult& point, const Wish& wish) {
  return point.ok() && within_error(point.measures, wish.error);
}

double error_of(const PointResult& point, const Wish& wish) {
  return error_at(point.measures, wish.error).distance;
}

std::optional<Pick> pick_of(const PointResult& point, const Wish& wish) {
  const auto frame = std::ranges::find_if(point.frame_times, [&wish](const FrameTime& f) {
    return std::abs(f.rate - wish.rate) < 1e-6;
  });
  if (frame == point.frame_times.end()) return {};
  return Pick{&point, *frame, error_of(point, wish)};
}

std::function<bool()> stop_at(const ChooseLimits& limits, double share) {
  return [&limits, until = share * limits.seconds] {
    return limits.interrupted() || limits.elapsed() >= until;
  };
}

std::vector<PointResult> screen_all(const std::vector<Search>& searches, const ChooseLimits& limits,
                                    const Runner& run) {
  const double most = screening_share * limits.seconds / static_cast<double>(searches.size());
  const auto stop = stop_at(limits, search_share);
  std::vector<PointResult> screened(searches.size());
  for (std::size_t i = 0; i < searches.size(); ++i) {
    PointSpec& spec = screened[i].spec = searches[i].base;
    spec.step = searches[i].ladder[searches[i].ladder.size() / 2];
    if (stop()) continue;
    try {
      screened[i] = run(spec, {.timeout = most,
                               .hopeless = std::min(usual_look, most),
                               .interrupted = stop,
                               .look = true});
    } catch (const Interrupted&) {
      screened[i].detail = "its first step took too long";
    }
  }
  return screened;
}

std::vector<PointResult*> fastest_runs(std::vector<PointResult>& points, const Wish& wish) {
  std::vector<PointResult*> list;
  for (PointResult& point : points)
    if (within(point, wish)) list.push_back(&point);
  std::ranges::sort(list, {}, &PointResult::seconds);
  list.resize(std::min(list.size(), finalists));
  return list;
}

void repeat_finalists(std::vector<PointResult>& points, const Suite& suite, const Wish& wish,
                      const ChooseLimits& limits, const Runner& run) {
  const auto stop = stop_at(limits, 1);
  try {
    for (std::size_t round = 1; round < final_samples; ++round)
      for (PointResult* point : fastest_runs(points, wish)) {
        if (stop()) return;
        add_sample(*point, run, {.timeout = suite.timeout, .interrupted = stop});
      }
  } catch (const Interrupted&) {
  }
}

Kept kept(const FrameTime& frame, double budget) {
  if (!(budget > 0) || frame.slow <= budget) return Kept::nearly_all;
  return frame.median <= budget ? Kept::half : Kept::fewer;
}

}  // namespace

std::vector<std::size_t> ladder_order(const std::vector<PointResult>& screened) {
  std::vector<std::size_t> order(screened.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&screened](std::size_t i) {
    const PointResult& point = screened[i];
    const int rank = point.ok() ? 0 : point.status == PointStatus::strain_missed ? 1 : 2;
    const bool timed = !point.samples.empty();
    return std::tuple(rank, !timed, timed ? point.seconds() : 0);
  });
  return order;
}

Trials try_contestants(const Suite& suite, const std::vector<Search>& searches, const Wish& wish,
                       const ChooseLimits& limits, const SweepEvents& events, const Runner& run) {
  Trials trials;
  trials.screened = screen_all(searches, limits, run);
  std::vector<Search> ordered;
  for (const std::size_t i : ladder_order(trials.screened)) ordered.push_back(searches[i]);
  SweepEvents until = events;
  until.interrupted = stop_at(limits, search_share);
  // On a busy machine, retaking samples takes most of the time. Finalists have more samples.
  const auto run_once = [&run](const PointSpec& spec, RunLimits own) {
    own.longest_wait = 0;
    return run(spec, own);
  };
  SweepOutcome outcome = run_sweep(suite, ordered, until, run_once);
  trials.points = std::move(outcome.points);
  trials.complete = outcome.complete;
  repeat_finalists(trials.points, suite, wish, limits, run);
  if (limits.interrupted()) throw Interrupted();
  return trials;
}

std::optional<Pick> fastest(const std::vector<PointResult>& points, const Wish& wish,
                            const std::string& not_by) {
  const auto rank = [&wish](const Pick& pick) {
    return std::pair(kept(pick.frame, wish.budget), pick.point->seconds());
  };
  std::optional<Pick> best;
  for (const PointResult& point : points) {
    if (point.spec.contestant == not_by || !within(point, wish)) continue;
    const auto pick = pick_of(point, wish);
    if (pick && (!best || rank(*pick) < rank(*best))) best = pick;
  }
  return best;
}

Recommendation recommend(const std::vector<PointResult>& points, const Wish& wish) {
  Recommendation found;
  found.best = fastest(points, wish);
  if (!found.best) return found;
  found.budget = kept(found.best->frame, wish.budget);
  Wish without_budget = wish;
  without_budget.budget = 0;
  found.next = fastest(points, without_budget, found.best->point->spec.contestant);
  return found;
}

std::string why_not(const std::string& contestant, const Trials& trials, const Wish& wish) {
  const PointResult *closest = nullptr, *failed = nullptr;
  for (const PointResult& point : trials.points) {
    if (point.spec.contestant != contestant) continue;
    if (within(point, wish)) return "";
    if (!point.ok()) failed = &point;
    if (point.ok() && (!closest || error_of(point, wish) < error_of(*closest, wish)))
      closest = &point;
  }
  const auto at = [](const PointResult& point) {
    return " at " + step_text(point.spec.step) + " s";
  };
  if (closest)
    return "error " + number_text(100 * error_of(*closest, wish), 2) + " %" + at(*closest);
  if (failed)
    return std::string(to_string(failed->status)) + at(*failed) + ": " + shortened(failed->detail);
  const auto seen = std::ranges::find_if(
      trials.screened, [&](const PointResult& p) { return p.spec.contestant == contestant; });
  if (seen == trials.screened.end() || (seen->samples.empty() && seen->detail.empty()))
    return "not tried, the time was over";
  if (seen->samples.empty()) return "not tried: " + shortened(seen->detail);
  return "no run ended in time; its first steps took " + duration_text(seen->seconds()) +
         " a simulated second";
}

}  // namespace harness
