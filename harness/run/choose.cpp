#include "harness/run/choose.h"

#include <algorithm>
#include <cmath>

namespace harness {
namespace {

std::optional<Pick> pick_of(const PointResult& point, const Wish& wish) {
  const auto frame =
      std::find_if(point.frame_times.begin(), point.frame_times.end(),
                   [&wish](const FrameTime& f) { return std::abs(f.rate - wish.rate) < 1e-6; });
  if (!point.ok() || frame == point.frame_times.end()) return {};
  return Pick{&point, *frame, error_at(point.measures, wish.error).distance};
}

}  // namespace

std::optional<Pick> fastest(const std::vector<PointResult>& points, const Wish& wish,
                            const std::string& not_by) {
  std::optional<Pick> best;
  for (const PointResult& point : points) {
    const auto pick = pick_of(point, wish);
    if (!pick || point.spec.name() == not_by || !within_error(point.measures, wish.error)) continue;
    if (!best || point.seconds() < best->point->seconds()) best = pick;
  }
  return best;
}

std::optional<Pick> most_accurate(const std::vector<PointResult>& points, const Wish& wish,
                                  double seconds) {
  const auto better = [](const Pick& a, const Pick& b) {
    if (std::isnan(a.error) || std::isnan(b.error))
      return std::isnan(a.error) && std::isnan(b.error) ? a.point->spec.step < b.point->spec.step
                                                        : std::isnan(b.error);
    return a.error < b.error;
  };
  std::optional<Pick> best;
  for (const PointResult& point : points) {
    const auto pick = pick_of(point, wish);
    if (!pick || pick->frame.slow > seconds) continue;
    if (!best || better(*pick, *best)) best = pick;
  }
  return best;
}

}  // namespace harness
