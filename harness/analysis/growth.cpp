#include "harness/analysis/growth.h"

#include <algorithm>
#include <cmath>

#include "harness/base/in_order.h"
#include "harness/base/text.h"

namespace harness::analysis {
namespace {

// Cells of any motion at one limit, from few vertices to many.
using Sizes = std::vector<std::pair<int, const Cell*>>;

const Entry* entry_of(const Cell& cell, const std::string& row) {
  const auto found =
      std::find_if(cell.entries.begin(), cell.entries.end(),
                   [&](const Entry& entry) { return entry.counts && entry.row == row; });
  return found == cell.entries.end() ? nullptr : &*found;
}

std::vector<std::string> rows_of(const Sizes& sizes) {
  std::vector<std::string> names;
  for (const auto& [vertices, cell] : sizes) {
    for (const Entry& entry : cell->entries) {
      if (entry.counts) names.push_back(entry.row);
    }
  }
  return in_order(names, [](const std::string& name) { return name; });
}

std::vector<RowGrowth> rows_in(const Sizes& sizes) {
  std::vector<RowGrowth> rows;
  for (const std::string& row : rows_of(sizes)) {
    std::vector<double> vertices, seconds;
    std::vector<Point> points;
    for (const auto& [size, cell] : sizes) {
      const Entry* entry = entry_of(*cell, row);
      if (!entry) continue;
      vertices.push_back(size);
      seconds.push_back(entry->point.seconds() * entry->point.number("step"));
      points.push_back(entry->point);
    }
    if (points.size() < 2) continue;
    rows.push_back({row, log_log_slope(vertices, seconds), points.front(), points.back()});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const RowGrowth& a, const RowGrowth& b) {
    return a.exponent.value < b.exponent.value;
  });
  return rows;
}

}  // namespace

std::vector<Growth> growth_in(const std::vector<Plane>& planes) {
  std::vector<Growth> all;
  std::vector<std::pair<std::string, double>> places;
  for (const Plane& plane : planes) {
    if (plane.sweep != "resolution") continue;
    for (const double limit : plane.limits) places.emplace_back(plane.scene, limit);
  }
  for (const auto& [scene, limit] : in_order(places, [](const auto& place) { return place; })) {
    Sizes sizes;
    for (const Plane& plane : planes) {
      const bool has =
          std::find(plane.limits.begin(), plane.limits.end(), limit) != plane.limits.end();
      if (plane.sweep == "resolution" && plane.scene == scene && has)
        sizes.emplace_back(plane.vertices, &plane.cell(limit, any_motion));
    }
    std::sort(sizes.begin(), sizes.end());
    Growth growth{scene, limit, rows_in(sizes)};
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
