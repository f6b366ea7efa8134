#include "harness/run/plane_table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "harness/analysis/plane.h"
#include "harness/analysis/words.h"
#include "harness/base/text.h"

namespace harness {

using analysis::Cell;
using analysis::Entry;
using analysis::percent;
using analysis::Plane;

namespace {

constexpr int limit_width = 9, level_width = 13, winner_width = 34, time_width = 9, step_width = 9,
              error_width = 9;

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

void print_cells(std::ostream& out, const std::string& limit, const Cell& loosest,
                 const Cell& tightest, double per_second) {
  out << std::left << std::setw(limit_width) << limit << std::setw(level_width)
      << levels_text(loosest, tightest);
  const Entry* first = tightest.first();
  if (!first) {
    out << "- " << tightest.empty_because << '\n';
    return;
  }
  const std::string name = first->row + (first->role.hollow ? " u" : "");
  out << std::setw(winner_width) << name + (tightest.clear() ? "" : " ~") << std::setw(time_width)
      << number_text(per_second * first->point.seconds(), 3) << std::setw(step_width)
      << step_text(first->point.number("step")) << std::setw(error_width)
      << (std::isnan(first->error) ? "?" : number_text(100 * first->error, 2) + " %")
      << lead_text(tightest) << '\n';
}

void print_head(std::ostream& out, const Plane& plane, bool sizes, bool seconds) {
  out << '\n' << plane.scene;
  if (!sizes) out << " of " << plane.vertices << " vertices";
  out << ", " << plane.sweep << " sweep";
  if (sizes && plane.limits.size() == 1) out << " at " << percent(plane.limits[0]) << " strain";
  out << ": the fastest within a strain limit and an error\n"
      << std::left << std::setw(limit_width) << (sizes ? "vertices" : "strain")
      << std::setw(level_width) << "error within" << std::setw(winner_width) << "fastest"
      << std::setw(time_width) << (seconds ? "s" : "ms") << std::setw(step_width) << "step, s"
      << std::setw(error_width) << "error"
      << "times as long: best of the paper\n";
}

void print_rows(std::ostream& out, const Plane& plane, bool sizes, bool seconds) {
  const std::size_t levels = plane.levels.size();
  for (std::size_t row = 0; row < plane.cells.size(); row += levels) {
    std::string place =
        sizes ? std::to_string(plane.vertices) : percent(plane.cells[row].strain_limit);
    for (std::size_t i = row, from = row; i < row + levels; ++i) {
      if (i + 1 < row + levels && same_answer(plane.cells[i], plane.cells[i + 1])) continue;
      print_cells(out, place, plane.cells[from], plane.cells[i], seconds ? 1 : 1e3);
      place.clear();
      from = i + 1;
    }
  }
}

// Of the fastest runs in the column "any", where their shape errors are known.
void print_shapes(std::ostream& out, const Plane& plane) {
  constexpr std::size_t width = 119;  // and a comma
  std::string line = "shape errors of the fastest, whatever their motion:";
  bool any = false;
  for (const Cell& cell : plane.cells) {
    const Entry* first = cell.level == any_motion ? cell.first() : nullptr;
    const double shape = first ? first->point.error("shape") : unknown;
    if (std::isnan(shape)) continue;
    const std::string word =
        " " + percent(cell.strain_limit) + ": " + number_text(100 * shape, 2) + " %";
    const std::string comma = any ? "," : "";
    if (line.size() + comma.size() + word.size() > width) {
      out << line << comma << '\n';
      line = " " + word;
    } else {
      line += comma + word;
    }
    any = true;
  }
  if (any) out << line << '\n';
}

// Times of a table of 20 s or more are in seconds.
bool in_seconds(const std::vector<Plane>& planes) {
  double most = 0;
  for (const Plane& plane : planes) {
    for (const Cell& cell : plane.cells) {
      if (const Entry* first = cell.first()) most = std::max(most, first->point.seconds());
    }
  }
  return most >= 20;
}

}  // namespace

void print_planes(std::ostream& out, const nlohmann::json& document) {
  const auto planes = analysis::planes_of(document);
  const bool seconds = in_seconds(planes);
  std::string last;
  for (const Plane& plane : planes) {
    const bool sizes = plane.sweep == "resolution";  // rows of one table
    if (!sizes || plane.scene != last) print_head(out, plane, sizes, seconds);
    last = sizes ? plane.scene : "";
    print_rows(out, plane, sizes, seconds);
    if (!sizes) print_shapes(out, plane);
  }
  if (!planes.empty())
    out << "(~: too close to the next to tell; u: with untuned settings; errors are over the "
           "scene's size)\n";
}

}  // namespace harness
