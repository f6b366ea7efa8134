#include "harness/run/report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/points/noise.h"

namespace harness {
namespace {

std::string axis_text(const PointSpec& spec) {
  if (spec.sweep == "strain") return number_text(100 * spec.strain_limit, 3) + " %";
  return spec.scene == "chain" ? std::to_string(spec.resolution)
                               : std::to_string(spec.resolution) + "^2";
}

// The failure that says most about a solver at one place of the axis: that of its finest step.
std::string failure_text(const std::vector<const PointResult*>& tried) {
  const auto finest = std::min_element(
      tried.begin(), tried.end(),
      [](const PointResult* a, const PointResult* b) { return a->spec.step < b->spec.step; });
  return to_string((*finest)->status);
}

constexpr int name_width = 30;

// s; adaptive: the mean one.
double step_length(const PointResult& point) {
  if (!point.spec.adaptive || point.work.steps == 0) return point.spec.step;
  return point.spec.step * point.steps_planned / static_cast<double>(point.work.steps);
}

template <class Text>  // Text(const Points&): what stands in a cell
void print_best(std::ostream& out, const std::vector<const PointResult*>& points,
                const std::string& title, const Text& cell_text) {
  std::vector<std::string> solvers, columns;
  std::map<std::pair<std::string, std::string>, std::vector<const PointResult*>> cells;
  for (const PointResult* point : points) {
    const std::string column = axis_text(point->spec);
    if (std::find(solvers.begin(), solvers.end(), point->spec.name()) == solvers.end())
      solvers.push_back(point->spec.name());
    if (std::find(columns.begin(), columns.end(), column) == columns.end())
      columns.push_back(column);
    cells[{point->spec.name(), column}].push_back(point);
  }
  out << '\n' << title << '\n';
  std::size_t longest = 15;
  for (const auto& cell : cells) longest = std::max(longest, cell_text(cell.second).size());
  const int cell_width = static_cast<int>(longest) + 2;
  out << std::left << std::setw(name_width) << "";
  for (const auto& column : columns) out << std::setw(cell_width) << column;
  out << '\n';
  for (const auto& solver : solvers) {
    out << std::setw(name_width) << solver;
    for (const auto& column : columns) {
      const auto cell = cells.find({solver, column});
      out << std::setw(cell_width) << (cell == cells.end() ? "-" : cell_text(cell->second));
    }
    out << '\n';
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

std::string time_and_step(const PointResult& point, const Unit& unit) {
  const std::string step = (point.spec.adaptive ? "~" : "") + step_text(step_length(point));
  const std::string end = point.at_ladder_end.empty() ? "" : ", " + point.at_ladder_end;
  return number_text(unit.per_second * point.median_seconds(), 3) + " (" + step + end + ")";
}

// Who is fastest at each place of the axis, and whether that is more than noise.
void print_fastest(std::ostream& out, const Suite& suite,
                   const std::vector<const PointResult*>& points, double noise) {
  const Contestants contestants = contestants_of(suite);
  const auto ranked = [&](const PointResult& p) {
    const auto who = std::find_if(contestants.begin(), contestants.end(),
                                  [&p](const Contestant& c) { return c.name == p.spec.name(); });
    return p.best && (who == contestants.end() || !who->hollow) &&
           (suite.same.empty() || p.spec.name() != double_of(suite.same));
  };
  const auto family = [](const PointResult& p) {
    const auto* backend = inextensible::find_backend(p.spec.solver);
    return std::string(backend ? backend->family : p.spec.solver.c_str());
  };
  std::vector<std::string> places;
  for (const PointResult* p : points) {
    if (std::find(places.begin(), places.end(), axis_text(p->spec)) == places.end())
      places.push_back(axis_text(p->spec));
  }
  out << "fastest:\n";
  for (const std::string& place : places) {
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
  std::vector<std::string> solvers;
  for (const PointResult* point : points) {
    if (std::find(solvers.begin(), solvers.end(), point->spec.name()) == solvers.end())
      solvers.push_back(point->spec.name());
  }
  const auto sure = [&](double target) {
    return std::any_of(points.begin(), points.end(), [&](const PointResult* point) {
      return error_known_until(point->measures, target) > 0;
    });
  };
  out << '\n'
      << scene << ", step sweep: seconds per simulated second to reach a trajectory error "
      << "(step in s, strain limit)\n";
  constexpr int cell_width = 25;
  out << std::left << std::setw(name_width) << "";
  for (const double target : targets) out << std::setw(cell_width) << number_text(target, 1);
  out << '\n';
  for (const auto& solver : solvers) {
    out << std::setw(name_width) << solver;
    for (const double target : targets) {
      const PointResult* fastest = nullptr;
      for (const PointResult* point : points) {
        if (point->spec.name() != solver || !point->ok() ||
            !(trajectory_within(point->measures, target) <= target))
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

// How the time of a step grows with the vertices, of each solver's best points, and what explains
// it at the largest of them.
void print_growth(std::ostream& out, const std::vector<const PointResult*>& points) {
  constexpr std::array<Column, 5> columns{{
      {"seconds a step",
       [](const PointResult& p) { return number_text(p.median_seconds() * step_length(p), 3); }},
      {"iterations a step",
       [](const PointResult& p) { return number_text(per_step(p, p.work.iterations), 3); }},
      {"linear iterations",
       [](const PointResult& p) { return number_text(per_step(p, p.work.linear_iterations), 3); }},
      {"set-up (s)", [](const PointResult& p) { return number_text(p.setup_seconds, 3); }},
      {"memory (GiB)",
       [](const PointResult& p) { return number_text(p.peak_rss_bytes / (1 << 30), 3); }},
  }};
  constexpr int cell_width = 22;
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
      seconds.push_back(p->median_seconds() * step_length(*p));
    }
    all.push_back({curve->first, log_log_slope(vertices, seconds), curve->second.begin()->second,
                   curve->second.rbegin()->second});
    curves.erase(curve);
  }
  std::erase_if(all, [](const Growth& growth) { return growth.exponent.points < 2; });
  return all;
}

void print_table(std::ostream& out, const Suite& suite, const std::vector<PointResult>& points) {
  const auto pair = pair_noise(points, suite.same);
  const double noise = pair ? pair->q95 : unknown;
  using Key = std::pair<std::string, std::string>;  // scene, sweep
  std::vector<Key> tables;
  bool within_error = false;
  for (const PointResult& point : points) {
    const Key key{point.spec.scene, point.spec.sweep};
    if (std::find(tables.begin(), tables.end(), key) == tables.end()) tables.push_back(key);
    within_error = within_error || point.best_at_error;
  }
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
    print_best(out, chosen, title + " (its step in s)", [&unit](const auto& cell) {
      const auto best =
          std::find_if(cell.begin(), cell.end(), [](const PointResult* p) { return p->best; });
      return best == cell.end() ? failure_text(cell) : time_and_step(**best, unit);
    });
    print_fastest(out, suite, chosen, noise);
    if (sweep == "resolution") print_growth(out, chosen);
    if (!within_error) continue;
    print_best(out, chosen, title + " within the error limit (its step in s)",
               [&unit](const auto& cell) -> std::string {
                 const auto best = std::find_if(cell.begin(), cell.end(), [](const PointResult* p) {
                   return p->best_at_error;
                 });
                 return best == cell.end() ? "error missed" : time_and_step(**best, unit);
               });
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

void print_reference(std::ostream& out, const Reference& reference) {
  out << reference.scene << ": " << reference.method << "\n  against " << reference.second_method
      << "\n  observed order " << number_text(reference.observed_order, 3) << ", valid until "
      << reference.valid_until << " s";
  if (reference.energy_drift > 0)
    out << ", energy drift " << number_text(reference.energy_drift, 2) << " of weight times size";
  out << "\n  gap (RMS distance of both routes over the scene's size), end vertex:\n";
  for (std::size_t i = 0; i < reference.times.size(); ++i) {
    out << "  t = " << reference.times[i] << " s  " << number_text(reference.gap[i], 2);
    if (i < reference.positions.size()) {
      const auto end = reference.positions[i].col(reference.positions[i].cols() - 1);
      out << "  (" << std::setprecision(12) << end.x() << ", " << end.y() << ", " << end.z() << ')'
          << std::setprecision(6);
    }
    out << '\n';
  }
}

}  // namespace harness
