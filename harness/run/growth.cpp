#include "harness/run/growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <map>

#include "harness/base/text.h"

namespace harness {
namespace {

std::string exponent_text(const Slope& slope) {
  std::string text = number_text(slope.value, 3);
  if (std::isfinite(slope.half_width))
    text += " (" + number_text(slope.low(), 3) + ".." + number_text(slope.high(), 3) + ")";
  return text;
}

// A column of the table of growth.
struct Column {
  const char* head;
  std::string (*text)(const PointResult&);
};

double per_step(const PointResult& point, std::int64_t count) {
  return static_cast<double>(count) /
         static_cast<double>(std::max<std::int64_t>(1, point.work.steps));
}

}  // namespace

std::vector<Growth> growths(const std::vector<const PointResult*>& points) {
  std::vector<Growth> all;
  std::map<std::string, std::map<int, const PointResult*>> curves;  // by solver, by vertices
  for (const PointResult* point : points) {
    if (point->best && point->ok()) curves[point->spec.name()][point->spec.vertices] = point;
  }
  for (const PointResult* point : points) {  // in the order of the sweep
    const auto curve = curves.find(point->spec.name());
    if (curve == curves.end()) continue;
    std::vector<double> vertices, seconds;
    for (const auto& [size, p] : curve->second) {
      vertices.push_back(size);
      seconds.push_back(p->seconds() * p->mean_step());
    }
    all.push_back({curve->first, log_log_slope(vertices, seconds), curve->second.begin()->second,
                   curve->second.rbegin()->second});
    curves.erase(curve);
  }
  std::erase_if(all, [](const Growth& growth) { return growth.exponent.points < 2; });
  return all;
}

void print_growth(std::ostream& out, const std::vector<const PointResult*>& points) {
  constexpr std::array<Column, 5> columns{{
      {"seconds a step",
       [](const PointResult& p) { return number_text(p.seconds() * p.mean_step(), 3); }},
      {"iterations a step",
       [](const PointResult& p) { return number_text(per_step(p, p.work.iterations), 3); }},
      {"linear iterations",
       [](const PointResult& p) { return number_text(per_step(p, p.work.linear_iterations), 3); }},
      {"set-up (s)", [](const PointResult& p) { return number_text(p.setup_seconds, 3); }},
      {"memory (GiB)",
       [](const PointResult& p) { return number_text(p.peak_rss_bytes / (1 << 30), 3); }},
  }};
  constexpr int name_width = 30, cell_width = 22;
  out << "growth of the time a step with vertices (exponent, 95 % interval), and the largest "
         "size:\n"
      << std::left << std::setw(name_width) << "" << std::setw(cell_width) << "exponent"
      << std::setw(cell_width) << "over vertices";
  for (const Column& column : columns) out << std::setw(cell_width) << column.head;
  out << '\n';
  for (const Growth& growth : growths(points)) {
    const PointResult& largest = *growth.largest;
    out << std::setw(name_width) << growth.solver << std::setw(cell_width)
        << exponent_text(growth.exponent) << std::setw(cell_width)
        << std::to_string(growth.smallest->spec.vertices) + ".." +
               std::to_string(largest.spec.vertices);
    for (const Column& column : columns) out << std::setw(cell_width) << column.text(largest);
    out << '\n';
  }
}

}  // namespace harness
