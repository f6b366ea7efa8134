#include "report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

namespace harness {
namespace {

std::string significant(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

// 1/250 for a step of 0.004 s.
std::string step_text(double step) { return "1/" + significant(1 / step, 6); }

std::string axis_text(const PointSpec& spec) {
  if (spec.sweep == "strain") return significant(100 * spec.strain_limit, 3) + " %";
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

std::string duration_text(double seconds) {
  if (seconds < 1) return significant(1000 * seconds, 3) + " ms";
  if (seconds < 100) return significant(seconds, 3) + " s";
  const long whole = std::lround(seconds);
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

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

void print_table(std::ostream& out, const std::vector<PointResult>& points) {
  using Key = std::pair<std::string, std::string>;  // scene, sweep
  std::vector<Key> tables;
  for (const PointResult& point : points) {
    const Key key{point.spec.scene, point.spec.sweep};
    if (std::find(tables.begin(), tables.end(), key) == tables.end()) tables.push_back(key);
  }
  for (const auto& [scene, sweep] : tables) {
    std::vector<std::string> solvers, columns;
    std::map<std::pair<std::string, std::string>, std::vector<const PointResult*>> cells;
    for (const PointResult& point : points) {
      if (point.spec.scene != scene || point.spec.sweep != sweep) continue;
      const std::string column = axis_text(point.spec);
      if (std::find(solvers.begin(), solvers.end(), point.spec.solver) == solvers.end())
        solvers.push_back(point.spec.solver);
      if (std::find(columns.begin(), columns.end(), column) == columns.end())
        columns.push_back(column);
      cells[{point.spec.solver, column}].push_back(&point);
    }
    out << '\n'
        << scene << ", " << (sweep == "strain" ? "strain limit" : "resolution")
        << " sweep: best seconds per simulated second (its step in s)\n";
    constexpr int name_width = 18, cell_width = 17;
    out << std::left << std::setw(name_width) << "";
    for (const auto& column : columns) out << std::setw(cell_width) << column;
    out << '\n';
    for (const auto& solver : solvers) {
      out << std::setw(name_width) << solver;
      for (const auto& column : columns) {
        const auto cell = cells.find({solver, column});
        std::string text = "-";
        if (cell != cells.end()) {
          const auto best = std::find_if(cell->second.begin(), cell->second.end(),
                                         [](const PointResult* p) { return p->best; });
          text = best == cell->second.end() ? failure_text(cell->second)
                                            : significant((*best)->median_seconds(), 3) + " (" +
                                                  step_text((*best)->spec.step) + ")";
        }
        out << std::setw(cell_width) << text;
      }
      out << '\n';
    }
  }
  std::map<std::string, int> failures;
  for (const PointResult& point : points) {
    if (!point.ok())
      ++failures[point.spec.scene + "/" + point.spec.solver + ": " + to_string(point.status)];
  }
  if (!failures.empty()) {
    out << "\nsteps that failed, all in the file with their reason:\n";
    for (const auto& [name, count] : failures) out << "  " << name << " x " << count << '\n';
  }
}

}  // namespace harness
