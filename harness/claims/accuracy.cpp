#include "harness/claims/accuracy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace harness::claims {

void residual_order(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if the residual after the first iteration falls at least with h^2 in every "
      "scene (slope over the four finest steps at the tightest limit, 95 % interval above 2 or "
      "containing it) and the last iteration's mean residual is at most 1.1 times the first's";
  bool order = true, later = true, any = false;
  for (const char* scene : {"chain", "drape"}) {
    double tightest = 1e300;
    const auto chosen = points.where([&](const Point& p) {
      return p.is("scene", scene) && p.is("sweep", "step") && p.is("solver", "fast_projection") &&
             p.ok() && std::isfinite(p.error("residual_first"));
    });
    for (const Point& p : chosen) tightest = std::min(tightest, p.number("strain_limit"));
    std::map<double, Point> by_step;
    for (const Point& p : chosen) {
      if (p.number("strain_limit") == tightest) by_step.try_emplace(p.number("step"), p);
    }
    if (by_step.size() < 4) continue;
    std::vector<double> h, first, last;
    double worst = 0;
    for (const auto& [step, p] : by_step) {
      if (h.size() == 4) break;
      h.push_back(step);
      first.push_back(p.error("residual_first"));
      last.push_back(p.error("residual_last"));
      worst = std::max(worst, last.back() / first.back());
      c.points.push_back(p.id());
    }
    const Slope slope = log_log_slope(h, first), slope_last = log_log_slope(h, last);
    any = true;
    order = order && slope.high() >= 2;
    later = later && worst <= 1.1;
    c.measured += (c.measured.empty() ? "" : "; ") + std::string(scene) + ": slope of the first " +
                  text(slope) + ", of the last " + text(slope_last) + ", last over first at most " +
                  text(worst, 2);
  }
  if (any) c.verdict = order && later ? reproduced : order || later ? changed : not_reproduced;
}

void same_frame(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the same frame: fast projection and ICD at the same step and limit; reproduced if their "
      "errors in shape (potential energy, corner height, shadow; after the drape's valid_until) "
      "differ by less than 1 % of the cloth's size at every step of 0.005 s and below";
  std::map<std::pair<double, double>, Point> icd;
  const auto drape = [&](const char* solver) {
    return points.where([&](const Point& p) {
      return p.is("scene", "drape") && p.is("sweep", "step") && p.is("solver", solver) && p.ok() &&
             p.number("step") <= 0.005 && std::isfinite(p.error("shape_corner_height"));
    });
  };
  for (const Point& p : drape("icd"))
    icd.try_emplace({p.number("step"), p.number("strain_limit")}, p);
  double worst = -1;
  for (const Point& p : drape("fast_projection")) {
    const auto other = icd.find({p.number("step"), p.number("strain_limit")});
    if (other == icd.end()) continue;
    for (const char* shape : {"shape_potential_energy", "shape_corner_height", "shape_shadow"})
      worst = std::max(worst, std::abs(p.error(shape) - other->second.error(shape)));
    c.points.push_back(p.id());
    c.points.push_back(other->second.id());
  }
  if (worst < 0) return;
  c.measured = "largest difference " + percent(worst) + " over " +
               std::to_string(c.points.size() / 2) + " pairs";
  c.verdict = worst < 0.01 ? reproduced : not_reproduced;
}

void strain_after_collision(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if the largest strain after the collision filter stays within 1.5 times the "
      "limit "
      "in every best run of fast projection; changed if within 1.5 times or 1 % of length, "
      "whichever is larger";
  bool tight = true, small = true;
  for (const auto& [limit, p] : points.best("drape", "strain", "fast_projection")) {
    const double after = p.number("max_strain_after_collision");
    if (!std::isfinite(after)) continue;
    c.points.push_back(p.id());
    tight = tight && after <= 1.5 * limit;
    small = small && after <= std::max(1.5 * limit, 0.01);
    c.measured += (c.measured.empty() ? "strain after collision: " : ", ") + percent(after) +
                  " at limit " + percent(limit);
  }
  if (!c.points.empty()) c.verdict = tight ? reproduced : small ? changed : not_reproduced;
}

}  // namespace harness::claims
