// Who gets through: of all runs that were tried, which ended well, what energy came back, and what
// contact took of their time.
#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {
namespace {

constexpr const char* introduction =
    "## Who gets through\n\nOf all runs, steps that were too long included: how many ended well, "
    "stopped ones not counted; the largest sum of rises of energy among these, over weight times "
    "size, where energy can only fall; and what contact took of their time, the median.\n\n";

// All runs of a contestant at one limit.
struct Survival {
  int tried = 0, finished = 0;
  double rise = std::nan("");         // the largest of those that finished
  std::vector<double> contact_parts;  // of their time
};

double contact_part(const Point& p) { return part_of_time(p, "contact"); }

// A run that is slower than others by far was stopped, and says nothing of survival.
bool says_something(const Point& p) {
  return !p.is("status", "timeout") && !p.is("status", "skipped");
}

Survival survival_of(const ScenePoints& scene, const std::string& contestant, double limit) {
  Survival found;
  for (const Point& p : scene.points) {
    if (p.contestant() != contestant || p.number("strain_limit") != limit || !says_something(p))
      continue;
    ++found.tried;
    if (!p.ok()) continue;
    ++found.finished;
    found.rise = std::fmax(found.rise, p.error("energy_rise"));
    if (const double part = contact_part(p); part > 0) found.contact_parts.push_back(part);
  }
  return found;
}

std::string told(const Survival& s) {
  if (s.tried == 0) return "-";
  std::string cell = std::to_string(s.finished) + " of " + std::to_string(s.tried);
  if (std::isfinite(s.rise)) cell += ", " + (s.rise < 1e-4 ? "<0.0001" : plain(s.rise, 2));
  if (!s.contact_parts.empty())
    cell += ", " + plain(100 * quantile(s.contact_parts, 0.5), 2) + " %";
  return cell;
}

bool energy_can_only_fall(const ScenePoints& scene) {
  return std::any_of(scene.points.begin(), scene.points.end(),
                     [](const Point& p) { return std::isfinite(p.error("energy_rise")); });
}

bool contact_was_timed(const ScenePoints& scene) {
  return std::any_of(scene.points.begin(), scene.points.end(),
                     [](const Point& p) { return contact_part(p) > 0; });
}

std::vector<double> limits_of(const ScenePoints& scene) {
  std::vector<double> limits;
  for (const Point& p : scene.points) limits.push_back(p.number("strain_limit"));
  std::sort(limits.begin(), limits.end(), std::greater<>());
  limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
  return limits;
}

void print_survivors(std::ostream& out, const ScenePoints& scene) {
  const std::vector<double> limits = limits_of(scene);
  std::vector<std::string> head{"contestant"};
  for (const double limit : limits) head.push_back(percent(limit));
  print_head(out, head);
  for (const Role& role : scene.contestants()) {
    std::vector<std::string> row{quoted(role.name)};
    for (const double limit : limits) row.push_back(told(survival_of(scene, role.name, limit)));
    print_row(out, row);
  }
  out << "\n";
}

}  // namespace

void print_survival(std::ostream& out, const std::vector<NamedResult>& results) {
  bool begun = false;
  for (const NamedResult& result : results) {
    for (const char* sweep : {"step", "strain"}) {
      for (const ScenePoints& scene : scenes_of(result.document, sweep, true)) {
        if (!energy_can_only_fall(scene) && !contact_was_timed(scene)) continue;
        if (!std::exchange(begun, true)) out << introduction;
        out << "### " << scene.title << ", " << sweep << " sweep (`" << result.name << "`)\n\n";
        print_survivors(out, scene);
      }
    }
  }
}

}  // namespace harness::claims
