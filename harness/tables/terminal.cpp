#include "harness/tables/terminal.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "harness/analysis/findings.h"
#include "harness/analysis/words.h"
#include "harness/base/text.h"

namespace harness {

using analysis::Cell;
using analysis::Entry;
using analysis::percent;
using analysis::Plane;

namespace {

constexpr int limit_width = 9, level_width = 13, time_width = 9, step_width = 9, error_width = 9;

// How a table is set: as wide as its names need.
struct Setting {
  int name_width = 0;
  bool seconds = false;  // else milliseconds

  std::string time(double value) const { return number_text((seconds ? 1 : 1e3) * value, 3); }
};

std::string level_text(double level) { return level == any_motion ? "any" : percent(level); }

// "any", "any to 5 %", "2 to 1 %".
std::string levels_text(const Cell& loosest, const Cell& tightest) {
  if (loosest.level == tightest.level) return level_text(loosest.level);
  const std::string from = level_text(loosest.level);
  return from.substr(0, from.find(" %")) + " to " + level_text(tightest.level);
}

// How the best of the paper's six compares.
std::string lead_text(const Cell& cell) {
  const Entry* paper = cell.paper_best();
  if (!paper) return "none of the six";
  if (paper == cell.first()) return "it is of the six";
  return analysis::text(*cell.lead_over(paper)) + " by " + paper->row;
}

bool same_answer(const Cell& a, const Cell& b) {
  if (!a.first() || !b.first())
    return !a.first() && !b.first() && a.empty_because == b.empty_because;
  return a.first()->point.id() == b.first()->point.id();
}

std::string percent_or_unknown(double fraction) {
  return std::isnan(fraction) ? "?" : number_text(100 * fraction, 2) + " %";
}

// Its name, step and time.
void print_entry(std::ostream& out, const Entry& entry, const std::string& name,
                 const Setting& set) {
  out << std::setw(set.name_width) << name << std::setw(time_width)
      << set.time(entry.point.seconds()) << std::setw(step_width)
      << step_text(entry.point.number("step")) << std::setw(error_width)
      << percent_or_unknown(entry.error);
}

std::string name_of(const Entry& entry) { return entry.row + (entry.role.unranked ? " u" : ""); }

void print_cells(std::ostream& out, const std::string& limit, const Cell& loosest,
                 const Cell& tightest, const Setting& set) {
  out << std::left << std::setw(limit_width) << limit << std::setw(level_width)
      << levels_text(loosest, tightest);
  const Entry* first = tightest.first();
  if (!first) {
    out << "- " << tightest.empty_because << '\n';
    return;
  }
  print_entry(out, *first,
              name_of(*first) + (tightest.counting(1) && !tightest.clear() ? " ~" : ""), set);
  out << lead_text(tightest) << '\n';
}

void print_head(std::ostream& out, const Plane& plane, bool sizes, const Setting& set) {
  out << '\n' << analysis::scene_words(plane.scene);
  if (!sizes) out << " of " << plane.vertices << " vertices";
  out << ", " << plane.sweep << " sweep";
  if (sizes && plane.limits.size() == 1) out << " at " << percent(plane.limits[0]) << " strain";
  out << ": the fastest within a strain limit and an error\n"
      << std::left << std::setw(limit_width) << (sizes ? "vertices" : "strain")
      << std::setw(level_width) << "error within" << std::setw(set.name_width) << "fastest"
      << std::setw(time_width) << (set.seconds ? "s" : "ms") << std::setw(step_width) << "step, s"
      << std::setw(error_width) << "error"
      << "times as long: best of the paper\n";
}

void print_rows(std::ostream& out, const Plane& plane, bool sizes, const Setting& set) {
  const std::size_t levels = plane.levels.size();
  for (std::size_t row = 0; row < plane.cells.size(); row += levels) {
    std::string place =
        sizes ? std::to_string(plane.vertices) : percent(plane.cells[row].strain_limit);
    for (std::size_t i = row, from = row; i < row + levels; ++i) {
      if (i + 1 < row + levels && same_answer(plane.cells[i], plane.cells[i + 1])) continue;
      print_cells(out, place, plane.cells[from], plane.cells[i], set);
      place.clear();
      from = i + 1;
    }
  }
}

// Shape errors of the fastest runs in the column "any", where they are known.
void print_shapes(std::ostream& out, const Plane& plane) {
  const char* before = "shape errors of the fastest, whatever their motion: ";
  for (const Cell& cell : plane.cells) {
    const Entry* first = cell.level == any_motion ? cell.first() : nullptr;
    const double shape = first ? first->point.error("shape") : unknown;
    if (std::isnan(shape)) continue;
    out << before << percent(cell.strain_limit) << ": " << number_text(100 * shape, 2) << " %";
    before = ", ";
  }
  if (before == std::string(", ")) out << '\n';
}

// Everybody in the cells of any motion and of the headline's error.
void print_everybody(std::ostream& out, const Plane& plane, const Setting& set) {
  for (const Cell& cell : plane.cells) {
    if (cell.entries.empty() || (cell.level != any_motion && cell.level != headline_error))
      continue;
    out << '\n'
        << analysis::scene_words(plane.scene) << " of " << plane.vertices << " vertices at "
        << percent(cell.strain_limit) << " strain, "
        << (cell.level == any_motion ? "any motion" : "motion error at most " + percent(cell.level))
        << '\n'
        << std::left << std::setw(set.name_width) << "" << std::setw(time_width)
        << (set.seconds ? "s" : "ms") << std::setw(step_width) << "step, s"
        << std::setw(error_width) << "error" << std::setw(error_width) << "strain"
        << "times the fastest\n";
    for (const Entry& entry : cell.entries) {
      const bool first = &entry == cell.first();
      print_entry(out, entry, entry.role.name, set);
      out << std::setw(error_width) << percent_or_unknown(entry.point.delivered_strain());
      out << (first || !cell.first() ? "1" : analysis::text(*cell.lead_over(&entry)))
          << (entry.counts           ? ""
              : entry.role.again     ? ", a second time"
              : !entry.role.competes ? ", no strain limit"
                                     : ", slower settings")
          << '\n';
    }
  }
}

// As wide as its longest name, and in seconds where something takes 20 of them.
Setting setting_of(const std::vector<Plane>& planes, bool all) {
  Setting set;
  std::size_t longest = 10;
  double most = 0;
  for (const Plane& plane : planes) {
    for (const Cell& cell : plane.cells) {
      for (const Entry& entry : cell.entries) {
        const bool shown = all || &entry == cell.first();
        if (!shown) continue;
        longest = std::max(longest, all ? entry.role.name.size() : name_of(entry).size() + 2);
        most = std::max(most, entry.point.seconds());
      }
    }
  }
  set.name_width = static_cast<int>(longest) + 2;
  set.seconds = most >= 20;
  return set;
}

void print_growth(std::ostream& out, const analysis::Growth& growth) {
  constexpr int name_width = 32, exponent_width = 24, range_width = 20, step_time_width = 14;
  out << '\n'
      << analysis::scene_words(growth.scene) << " at " << percent(growth.strain_limit)
      << " strain, any motion: the time of a step grows as the number of vertices to a power\n"
      << std::left << std::setw(name_width) << "" << std::setw(exponent_width) << "power (95 %)"
      << std::setw(range_width) << "vertices" << std::setw(step_time_width) << "ms a step"
      << "GiB at the largest\n";
  for (const analysis::RowGrowth& row : growth.rows) {
    const analysis::Point& largest = row.largest;
    out << std::setw(name_width) << row.row << std::setw(exponent_width)
        << analysis::exponent_words(row.exponent) << std::setw(range_width)
        << number_text(row.smallest.number("vertices"), 7) + ".." +
               number_text(largest.number("vertices"), 7)
        << std::setw(step_time_width)
        << number_text(1e3 * largest.seconds() * largest.number("step"), 3)
        << number_text(largest.number("peak_rss_bytes") / (1 << 30), 3) << '\n';
  }
}

// How runs that failed did so.
void print_failures(std::ostream& out, const nlohmann::json& document, bool all) {
  std::map<std::string, int> statuses;
  std::map<std::string, int> of_contestants;
  int failed = 0;
  for (const nlohmann::json& p : document.at("points")) {
    const std::string status = p.at("status");
    if (status == "ok") continue;
    ++failed;
    ++statuses[status];
    ++of_contestants[p.at("scene").get<std::string>() + ", " +
                     p.value("contestant", p.at("solver").get<std::string>()) + ": " + status];
  }
  if (failed == 0) return;
  std::string line = "\n" + std::to_string(failed) + " of " +
                     std::to_string(document.at("points").size()) +
                     " trial runs failed (coarse steps are tried until they do):";
  for (const auto& [status, count] : statuses)
    line += (line.back() == ':' ? " " : ", ") + status + " " + std::to_string(count);
  out << line << '\n';
  if (!all) return;
  for (const auto& [name, count] : of_contestants) out << "  " << name << " x " << count << '\n';
}

// Which solvers came from plug-ins, of which version, and what copying states into an engine and
// out of it took of their time.
void print_plugins(std::ostream& out, const nlohmann::json& document) {
  const auto context = document.value("context", nlohmann::json::object());
  const char* before = "\n";
  for (const auto& plugin : context.value("plugins", nlohmann::json::array())) {
    for (const auto& solver : plugin.at("solvers")) {
      double copy = 0, all = 0;  // s
      for (const auto& point : document.at("points")) {
        if (point.at("solver") != solver || point.at("status") != "ok") continue;
        const auto phases = point.value("phases", nlohmann::json::object());
        copy += phases.value("copy", 0.0);
        for (const char* phase : {"unconstrained", "filter", "collision", "copy"})
          all += phases.value(phase, 0.0);
      }
      out << before << "plug-in " << solver.get<std::string>() << ": "
          << plugin.at("version").get<std::string>();
      if (copy > 0) out << "; copying its state takes " << percent(copy / all) << " of its time";
      out << '\n';
      before = "";
    }
  }
}

void print_whole(std::ostream& out, const nlohmann::json& document, bool all) {
  const auto planes = analysis::planes_of(document);
  const Setting set = setting_of(planes, all);
  std::string last;
  for (const Plane& plane : planes) {
    const bool sizes = plane.sweep == "resolution";  // rows of one table
    if (!sizes || plane.scene != last) print_head(out, plane, sizes, set);
    last = sizes ? plane.scene : "";
    print_rows(out, plane, sizes, set);
    if (!sizes) print_shapes(out, plane);
  }
  if (planes.empty())
    out << "\nall of these runs chose their steps by a controller, which is not ranked: bench plot "
           "draws them\n";
  else
    out << "(~: too close to the next, or too few samples, to tell; u: with untuned settings; "
           "errors are over the scene's size)\n";
  for (const Plane& plane : planes) {
    if (all) print_everybody(out, plane, set);
  }
  for (const analysis::Growth& growth : analysis::growth_in(planes)) print_growth(out, growth);
  for (const analysis::Finding& finding : analysis::findings_of(planes)) {
    out << '\n' << finding.subject << ":\n";
    for (const std::string& sentence : finding.sentences) out << sentence << '\n';
  }
  print_failures(out, document, all);
  print_plugins(out, document);
}

}  // namespace

void print_sweep(std::ostream& out, const nlohmann::json& document, bool all, std::size_t columns) {
  std::ostringstream text;
  print_whole(text, document, all);
  out << fitted(text.str(), columns);
}

}  // namespace harness
