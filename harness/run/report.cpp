#include "harness/run/report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "harness/base/in_order.h"
#include "harness/base/text.h"
#include "harness/run/growth.h"

namespace harness {
namespace {

std::string axis_text(const PointSpec& spec) {
  if (spec.sweep == "strain") return number_text(100 * spec.strain_limit, 3) + " %";
  return spec.scene == "chain" ? std::to_string(spec.resolution)
                               : std::to_string(spec.resolution) + "^2";
}

std::string place_of(const PointResult* point) { return axis_text(point->spec); }
std::string name_of(const PointResult* point) { return point->spec.name(); }

// The failure that says most about a solver at one place of the axis: that of its finest step.
std::string failure_text(const std::vector<const PointResult*>& tried) {
  const auto finest = std::min_element(
      tried.begin(), tried.end(),
      [](const PointResult* a, const PointResult* b) { return a->spec.step < b->spec.step; });
  return to_string((*finest)->status);
}

constexpr int name_width = 32, table_width = 120;

// As many columns at a time as a line has room for. text(row, column): what stands in a cell.
template <class Text>
void print_grid(std::ostream& out, const std::vector<std::string>& rows,
                const std::vector<std::string>& columns, const Text& text) {
  std::size_t longest = 10;
  for (const auto& row : rows) {
    for (const auto& column : columns) longest = std::max(longest, text(row, column).size());
  }
  const int cell_width = static_cast<int>(longest) + 2;
  const auto room = static_cast<std::size_t>(std::max(1, (table_width - name_width) / cell_width));
  for (std::size_t from = 0; from < columns.size(); from += room) {
    const auto to = std::min(columns.size(), from + room);
    const auto line = [&](const std::string& name, const auto& cell) {
      out << std::left << std::setw(name_width) << name;
      for (std::size_t i = from; i < to; ++i)
        out << std::setw(i + 1 < to ? cell_width : 0) << cell(columns[i]);
      out << '\n';
    };
    line("", [](const std::string& column) { return column; });
    for (const auto& row : rows)
      line(row, [&](const std::string& column) { return text(row, column); });
  }
}

template <class Text>  // Text(const Points&): what stands in a cell
void print_best(std::ostream& out, const std::vector<const PointResult*>& points,
                const std::string& title, const Text& cell_text) {
  std::map<std::pair<std::string, std::string>, std::vector<const PointResult*>> cells;
  for (const PointResult* point : points)
    cells[{point->spec.name(), axis_text(point->spec)}].push_back(point);
  out << '\n' << title << '\n';
  print_grid(out, in_order(points, name_of), in_order(points, place_of),
             [&](const std::string& solver, const std::string& column) {
               const auto cell = cells.find({solver, column});
               return cell == cells.end() ? "-" : cell_text(cell->second);
             });
}

// Of all times of one table.
struct Unit {
  const char* name;
  double per_second;
};

Unit unit_of(const std::vector<const PointResult*>& points) {
  double most = 0;
  for (const PointResult* p : points) {
    if (p->best) most = std::max(most, p->seconds());
  }
  return most >= 20 ? Unit{"s", 1} : Unit{"ms", 1e3};
}

// With its error, where that is known.
std::string time_and_step(const PointResult& point, const Unit& unit) {
  const std::string step = (point.spec.adaptive ? "~" : "") + step_text(point.mean_step());
  const std::string end = point.at_ladder_end.empty() ? "" : ", " + point.at_ladder_end;
  const double error = point.measures.trajectory;
  return number_text(unit.per_second * point.seconds(), 3) + " (" + step + end +
         (std::isnan(error) ? "" : ", " + number_text(100 * error, 2) + " %") + ")";
}

// The fastest point of each solver within each of some errors: step and strain limit are free.
void print_time_to_error(std::ostream& out, const std::vector<const PointResult*>& points,
                         const std::string& scene) {
  constexpr std::array targets{1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4};
  const auto sure = [&](double target) {
    return std::any_of(points.begin(), points.end(), [&](const PointResult* point) {
      return error_at(point->measures, target).samples > 0;
    });
  };
  out << '\n'
      << scene << ", step sweep: seconds per simulated second to reach a trajectory error "
      << "(step in s, strain limit)\n";
  std::vector<std::string> columns;
  columns.reserve(targets.size());
  for (const double target : targets) columns.push_back(number_text(target, 1));
  const auto cell = [&](const std::string& solver, const std::string& column) -> std::string {
    const double target = std::stod(column);
    if (!sure(target)) return "< 3 gap";
    const PointResult* fastest = nullptr;
    for (const PointResult* point : points) {
      if (point->spec.name() != solver || !point->ok() || !within_error(point->measures, target))
        continue;
      if (!fastest || point->seconds() < fastest->seconds()) fastest = point;
    }
    if (!fastest) return "-";
    return number_text(fastest->seconds(), 3) + " (" + step_text(fastest->spec.step) + ", " +
           number_text(100 * fastest->spec.strain_limit, 3) + " %)";
  };
  print_grid(out, in_order(points, name_of), columns, cell);
}

}  // namespace

void print_table(std::ostream& out, const std::vector<PointResult>& points) {
  const auto tables =
      in_order(points, [](const PointResult& p) { return std::pair(p.spec.scene, p.spec.sweep); });
  for (const auto& [scene, sweep] : tables) {
    std::vector<const PointResult*> chosen;
    for (const PointResult& point : points) {
      if (point.spec.scene == scene && point.spec.sweep == sweep) chosen.push_back(&point);
    }
    if (sweep == "step") {
      print_time_to_error(out, chosen, scene);
      continue;
    }
    const std::string axis = sweep == "strain" ? "strain limit" : "resolution";
    const Unit unit = unit_of(chosen);
    const std::string title = scene + ", " + axis + " sweep: least time, " + unit.name +
                              " of computation for a simulated second";
    print_best(
        out, chosen, title + ", any motion (its step in s, error)", [&unit](const auto& cell) {
          const auto best =
              std::find_if(cell.begin(), cell.end(), [](const PointResult* p) { return p->best; });
          return best == cell.end() ? failure_text(cell) : time_and_step(**best, unit);
        });
    if (sweep == "resolution") print_growth(out, chosen);
  }
  std::map<std::string, int> failures;
  for (const PointResult& point : points) {
    if (!point.ok())
      ++failures[point.spec.scene + "/" + point.spec.name() + ": " + to_string(point.status)];
  }
  if (!failures.empty()) {
    out << "\nsteps that failed, all in the file with their reason:\n";
    for (const auto& [name, count] : failures) out << "  " << name << " x " << count << '\n';
  }
}

}  // namespace harness
