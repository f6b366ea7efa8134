#include "harness/analysis/growth.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "harness/base/in_order.h"
#include "harness/base/text.h"

namespace harness::analysis {
namespace {

// Of one row of the ranking at one limit, from few vertices to many.
RowGrowth growth_of(const std::string& row, const std::vector<Entry>& entries) {
  std::vector<double> vertices, seconds;
  for (const Entry& entry : entries) {
    vertices.push_back(entry.point.spec().vertices);
    seconds.push_back(entry.point.seconds() * entry.point.spec().step);
  }
  return {row, log_log_slope(vertices, seconds), entries.front().point, entries.back().point};
}

}  // namespace

std::vector<Growth> growth_in(const std::vector<Plane>& planes) {
  std::vector<const Plane*> sizes;
  for (const Plane& plane : planes) {
    if (plane.sweep == "resolution") sizes.push_back(&plane);
  }
  std::vector<std::pair<std::string, double>> places;
  for (const Plane* plane : sizes) {
    for (const double limit : plane->limits) places.emplace_back(plane->scene, limit);
  }
  std::ranges::stable_sort(sizes, {}, &Plane::vertices);
  std::vector<Growth> all;
  for (const auto& [scene, limit] : in_order(places, std::identity())) {
    std::vector<Entry> entries;
    for (const Plane* plane : sizes) {
      if (plane->scene != scene || !std::ranges::count(plane->limits, limit)) continue;
      std::ranges::copy_if(plane->cell(limit, any_motion).entries, std::back_inserter(entries),
                           &Entry::counts);
    }
    Growth growth{scene, limit, {}};
    for (const auto& [row, own] : grouped(entries, [](const Entry& e) { return e.row; })) {
      if (own.size() > 1) growth.rows.push_back(growth_of(row, own));
    }
    std::ranges::stable_sort(growth.rows, {}, [](const RowGrowth& r) { return r.exponent.value; });
    if (!growth.rows.empty()) all.push_back(std::move(growth));
  }
  return all;
}

std::string exponent_words(const Slope& exponent) {
  std::string words = number_text(exponent.value, 3);
  if (std::isfinite(exponent.half_width))
    words += " (" + number_text(exponent.low(), 3) + " to " + number_text(exponent.high(), 3) + ")";
  return words;
}

}  // namespace harness::analysis
