#include "harness/run/report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "harness/base/in_order.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/points/noise.h"
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

template <class Text>  // Text(const Points&): what stands in a cell
void print_best(std::ostream& out, const std::vector<const PointResult*>& points,
                const std::string& title, const Text& cell_text) {
  std::map<std::pair<std::string, std::string>, std::vector<const PointResult*>> cells;
  for (const PointResult* point : points)
    cells[{point->spec.name(), axis_text(point->spec)}].push_back(point);
  out << '\n' << title << '\n';
  std::size_t longest = 15;
  for (const auto& cell : cells) longest = std::max(longest, cell_text(cell.second).size());
  const int cell_width = static_cast<int>(longest) + 2;
  const auto columns = in_order(points, place_of);
  // As many columns at a time as a line has room for.
  const auto room =
      static_cast<std::size_t>(std::max(1, (table_width - name_width) / std::max(1, cell_width)));
  for (std::size_t from = 0; from < columns.size(); from += room) {
    const auto to = std::min(columns.size(), from + room);
    const auto row = [&](const std::string& name, const auto& text_of) {
      out << std::left << std::setw(name_width) << name;
      for (std::size_t i = from; i < to; ++i)
        out << (i + 1 < to ? std::setw(cell_width) : std::setw(0)) << text_of(columns[i]);
      out << '\n';
    };
    row("", [](const std::string& column) { return column; });
    for (const auto& solver : in_order(points, name_of))
      row(solver, [&](const std::string& column) {
        const auto cell = cells.find({solver, column});
        return cell == cells.end() ? "-" : cell_text(cell->second);
      });
  }
}

// Of all times of one table.
struct Unit {
  const char* name;
  double per_second;
};

Unit unit_of(const std::vector<const PointResult*>& points) {
  double most = 0;
  for (const PointResult* p : points) {
    if (p->best) most = std::max(most, p->median_seconds());
  }
  return most >= 20 ? Unit{"s", 1} : Unit{"ms", 1e3};
}

// With its error, where that is known.
std::string time_and_step(const PointResult& point, const Unit& unit) {
  const std::string step = (point.spec.adaptive ? "~" : "") + step_text(point.mean_step());
  const std::string end = point.at_ladder_end.empty() ? "" : ", " + point.at_ladder_end;
  const double error = point.measures.trajectory;
  return number_text(unit.per_second * point.median_seconds(), 3) + " (" + step + end +
         (std::isnan(error) ? "" : ", " + number_text(100 * error, 2) + " %") + ")";
}

// Who is fastest at each place of the axis, with tuned or untuned settings, and whether that is
// more than noise.
void print_fastest(std::ostream& out, const Suite& suite,
                   const std::vector<const PointResult*>& points, double noise) {
  const auto ranked = [&](const PointResult& p) {
    return p.best && (suite.same.empty() || p.spec.name() != double_of(suite.same));
  };
  const auto family = [](const PointResult& p) {
    const auto* backend = inextensible::find_backend(p.spec.solver);
    return std::string(backend ? backend->family : p.spec.solver.c_str());
  };
  out << "fastest:\n";
  for (const std::string& place : in_order(points, place_of)) {
    std::vector<const PointResult*> here;
    for (const PointResult* p : points) {
      if (axis_text(p->spec) == place && ranked(*p)) here.push_back(p);
    }
    if (here.empty()) continue;
    std::sort(here.begin(), here.end(), [](const PointResult* a, const PointResult* b) {
      return a->median_seconds() < b->median_seconds();
    });
    const PointResult& first = *here.front();
    const auto other = std::find_if(here.begin(), here.end(), [&](const PointResult* p) {
      return family(*p) != family(first);
    });
    out << "  " << std::left << std::setw(8) << place << first.spec.name();
    if (other != here.end()) {
      const Ratio slower = ratio_of_medians((*other)->samples, first.samples, noise);
      out << "; " << (*other)->spec.name() << " takes " << number_text(slower.value, 3)
          << " times as long";
      if (slower.known())
        out << " (" << number_text(slower.low, 3) << " to " << number_text(slower.high, 3) << ")";
      if (!slower.above(1)) out << ", too close to tell";
    }
    out << '\n';
  }
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
  constexpr int cell_width = 25;
  out << std::left << std::setw(name_width) << "";
  for (const double target : targets) out << std::setw(cell_width) << number_text(target, 1);
  out << '\n';
  for (const auto& solver : in_order(points, name_of)) {
    out << std::setw(name_width) << solver;
    for (const double target : targets) {
      const PointResult* fastest = nullptr;
      for (const PointResult* point : points) {
        if (point->spec.name() != solver || !point->ok() || !within_error(point->measures, target))
          continue;
        if (!fastest || point->median_seconds() < fastest->median_seconds()) fastest = point;
      }
      std::string text = "-";
      if (!sure(target)) {
        text = "< 3 gap";
      } else if (fastest) {
        text = number_text(fastest->median_seconds(), 3) + " (" + step_text(fastest->spec.step) +
               ", " + number_text(100 * fastest->spec.strain_limit, 3) + " %)";
      }
      out << std::setw(cell_width) << text;
    }
    out << '\n';
  }
}

}  // namespace

void print_table(std::ostream& out, const Suite& suite, const std::vector<PointResult>& points) {
  const auto pair = pair_noise(points, suite.same);
  const double noise = pair ? pair->q95 : unknown;
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
    print_fastest(out, suite, chosen, noise);
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
