#include "harness/run/report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "harness/base/text.h"

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

}  // namespace

Progress::Progress(std::ostream& out, bool terminal) : out_(out), terminal_(terminal) {}

void Progress::point(const PointResult& point, std::size_t search, std::size_t searches) {
  ++points_;
  std::string text = point.spec.id() + " ";
  text += point.ok() ? duration_text(point.median_seconds()) + "/s" : to_string(point.status);
  if (!terminal_) {
    out_ << "[" << search + 1 << "/" << searches << "] " << text;
    if (!point.ok()) out_ << " (" << point.detail << ")";
    out_ << std::endl;
    return;
  }
  bar((static_cast<double>(search) + 0.5) / static_cast<double>(searches), text);
}

void Progress::repetition(std::size_t done, std::size_t all) {
  if (terminal_) {
    bar(1, "repeating best points " + std::to_string(done) + "/" + std::to_string(all));
  } else if (done == all) {
    out_ << "repeated the best points, " << all << " runs" << std::endl;
  }
}

void Progress::bar(double fraction, const std::string& text) {
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  constexpr std::size_t cells = 20;
  const auto filled = static_cast<std::size_t>(fraction * cells);
  std::string line = "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "] " +
                     std::to_string(points_) + " points, " + duration_text(elapsed);
  if (fraction > 0.02 && fraction < 1)
    line += ", about " + duration_text(elapsed * (1 - fraction) / fraction) + " left";
  line += "  " + text;
  constexpr std::size_t columns = 118;
  if (line.size() > columns) line.resize(columns);
  const std::size_t width = line.size();
  if (width < width_) line.append(width_ - width, ' ');
  width_ = width;
  out_ << '\r' << line << std::flush;
}

void Progress::finish() {
  if (terminal_ && points_ > 0) out_ << '\r' << std::string(width_, ' ') << '\r' << std::flush;
}

namespace {

constexpr int name_width = 26;

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

std::string time_and_step(const PointResult& point) {
  const std::string step = (point.spec.adaptive ? "~" : "") + step_text(step_length(point));
  const std::string end = point.at_ladder_end.empty() ? "" : ", " + point.at_ladder_end;
  return number_text(point.median_seconds(), 3) + " (" + step + end + ")";
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

void print_table(std::ostream& out, const std::vector<PointResult>& points) {
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
    const std::string title = scene + ", " + axis + " sweep: best seconds per simulated second";
    print_best(out, chosen, title + " (its step in s)", [](const auto& cell) {
      const auto best =
          std::find_if(cell.begin(), cell.end(), [](const PointResult* p) { return p->best; });
      return best == cell.end() ? failure_text(cell) : time_and_step(**best);
    });
    if (sweep == "resolution") print_growth(out, chosen);
    if (!within_error) continue;
    print_best(out, chosen, title + " within the error limit (its step in s)",
               [](const auto& cell) -> std::string {
                 const auto best = std::find_if(cell.begin(), cell.end(), [](const PointResult* p) {
                   return p->best_at_error;
                 });
                 return best == cell.end() ? "error missed" : time_and_step(**best);
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
