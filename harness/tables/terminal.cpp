#include "harness/tables/tables.h"

namespace harness {

using namespace analysis;  // tables print what was analysed

namespace {

std::string level_text(double level) { return level == any_motion ? "any" : percent(level); }

// "any", "any to 5 %", "2 to 1 %".
std::string levels_text(const Cell& loosest, const Cell& tightest) {
  if (loosest.level == tightest.level) return level_text(loosest.level);
  const std::string from = level_text(loosest.level);
  return from.substr(0, from.find(" %")) + " to " + level_text(tightest.level);
}

std::string lead_text(const Cell& cell) {
  const Entry* paper = cell.rival(Rival::paper_best);
  if (!paper) return "none of the six";
  if (paper == cell.first()) return "itself one of the six";
  return analysis::text(*cell.lead_over(paper)) + " " + paper->row;
}

bool same_answer(const Cell& a, const Cell& b) {
  if (!a.first() || !b.first())
    return !a.first() && !b.first() && a.empty_because == b.empty_because;
  return a.first()->point.id() == b.first()->point.id();
}

std::string percent_or_unknown(double fraction) {
  return std::isnan(fraction) ? "?" : number_text(100 * fraction, 2) + " %";
}

std::vector<std::string> entry_cells(const Entry& entry, const std::string& name) {
  return {name, time_words(entry.point.seconds()), step_text(entry.point.step()),
          percent_or_unknown(entry.error)};
}

std::vector<std::string> answer_row(const std::string& place, const Cell& loosest,
                                    const Cell& tightest) {
  const std::string levels = levels_text(loosest, tightest);
  const Entry* first = tightest.first();
  if (!first) return {place, levels, "- " + tightest.empty_because};
  auto row = entry_cells(*first, first->row + (first->role.unranked ? " u" : "") +
                                     (tightest.counting(1) && !tightest.clear() ? " ~" : ""));
  row.insert(row.begin(), {place, levels});
  row.push_back(tightest.known_until > 0 ? number_text(tightest.known_until) + " s" : "-");
  row.push_back(lead_text(tightest));
  return row;
}

// Consecutive error levels with the same answer share a row.
void add_answers(Table& table, const Plane& plane, bool sizes) {
  const std::size_t levels = plane.levels.size();
  for (std::size_t row = 0; row < plane.cells.size(); row += levels) {
    std::string place =
        sizes ? std::to_string(plane.vertices) : percent(plane.cells[row].strain_limit);
    for (std::size_t i = row, from = row; i < row + levels; ++i) {
      if (i + 1 < row + levels && same_answer(plane.cells[i], plane.cells[i + 1])) continue;
      table.rows.push_back(answer_row(place, plane.cells[from], plane.cells[i]));
      place.clear();
      from = i + 1;
    }
  }
}

void print_grid(std::ostream& out, const std::vector<Plane>& planes) {
  for (const auto& [title, group] : grouped(planes, title_of)) {
    const bool sizes = group.front().sweep == "resolution";
    Table table{{sizes ? "vertices" : "strain", "within", "fastest", "time", "step, s", "error",
                 "known to", "times as long: best of the paper"}};
    for (const Plane& plane : group) add_answers(table, plane, sizes);
    out << '\n' << title << ": the fastest within a strain limit and an error\n";
    print_aligned(out, table);
  }
}

// All contestants, at any motion and at the headline's error.
void print_everybody(std::ostream& out, const Plane& plane) {
  for (const Cell& cell : plane.cells) {
    if (cell.entries.empty() || (cell.level != any_motion && cell.level != headline_error))
      continue;
    Table table{{"", "time", "step, s", "error", "strain", "times the fastest"}};
    for (const Entry& entry : cell.entries) {
      const bool first = &entry == cell.first();
      auto row = entry_cells(entry, entry.role.name);
      row.push_back(percent_or_unknown(entry.point.delivered_strain()));
      row.push_back((first || !cell.first() ? "1" : analysis::text(*cell.lead_over(&entry))) +
                    (entry.counts           ? ""
                     : entry.role.again     ? ", a second time"
                     : !entry.role.competes ? ", no strain limit"
                                            : ", slower settings"));
      table.rows.push_back(std::move(row));
    }
    out << '\n'
        << scene_words(plane.scene) << " of " << plane.vertices << " vertices at "
        << percent(cell.strain_limit) << " strain, "
        << (cell.level == any_motion ? "any motion" : "motion error at most " + percent(cell.level))
        << '\n';
    print_aligned(out, table);
  }
}

void print_failures(std::ostream& out, const Runs& runs, bool all) {
  std::map<std::string, int> statuses, of_contestants;
  int failed = 0;
  for (const Point& point : runs.points) {
    if (point.ok()) continue;
    ++failed;
    const std::string status = to_string(point.result().status);
    ++statuses[status];
    ++of_contestants[point.scene() + ", " + point.contestant() + ": " + status];
  }
  if (failed == 0) return;
  std::string counts;
  for (const auto& [status, count] : statuses) append(counts, status + " " + std::to_string(count));
  out << '\n'
      << failed << " of " << runs.points.size()
      << " trial runs failed (coarse steps are tried until they do): " << counts << '\n';
  if (!all) return;
  for (const auto& [name, count] : of_contestants) out << "  " << name << " x " << count << '\n';
}

void print_noise(std::ostream& out, const json& document) {
  const json& context = document.at("context");
  if (const auto pair = noise_of(context))
    out << "\n"
        << pair->pair[0] << " ran twice under two names: in 95 % of " << pair->places
        << " places its two times are within " << number_text(100 * std::expm1(pair->q95), 2)
        << " % of each other; smaller differences between solvers are noise\n";
  if (document.contains("warning"))
    out << "\n" << document.at("warning").get<std::string>() << '\n';
  if (const json kernel = context.value("sentinel", json::object()); kernel.value("noisy", false))
    out << "\nNOISY: a fixed kernel's time varied by "
        << number_text(100 * kernel.value("spread", 0.0), 2)
        << " % during the run; counters and errors are valid, compare times with care\n";
}

// Runs whose times mean nothing: the least error of each contestant, and the strain that goes with
// it.
void print_errors(std::ostream& out, const Runs& runs) {
  const auto place_of = [](const Point& point) {
    return scene_words(point.scene()) + " of " + number_text(point.vertices()) + " vertices at " +
           percent(point.strain_limit()) + " strain";
  };
  const auto rank = [](const Point& point) {
    const double error = point.error_at(any_motion).distance;
    return std::tuple(!point.ok(), std::isnan(error), error);
  };
  for (const auto& [place, points] : grouped(runs.points, place_of)) {
    Table table{{"", "step, s", "error", "strain"}};
    for (const auto& [name, own] : grouped(points, &Point::contestant)) {
      const Point& best = *std::ranges::min_element(own, {}, rank);
      if (best.ok())
        table.rows.push_back({name, step_text(best.step()),
                              percent_or_unknown(best.error_at(any_motion).distance),
                              percent_or_unknown(best.delivered_strain())});
    }
    out << '\n' << place << ": the least error of each contestant\n";
    print_aligned(out, table);
  }
}

}  // namespace

void print_sweep(std::ostream& out, const json& document, const std::string& file, bool all) {
  const Runs runs(document);
  if (!is_timed(document)) {
    print_errors(out, runs);
    return print_failures(out, runs, all);
  }
  const auto planes = planes_of(runs);
  print_grid(out, planes);
  out << "(~: too close to the next, or too few samples, to tell; u: with settings other than its "
         "tuned ones; errors are over the scene's size)\n";
  for (const Plane& plane : planes)
    if (all) print_everybody(out, plane);
  for (const Finding& finding : findings_of(planes)) {
    out << '\n' << finding.subject << ":\n";
    for (const std::string& sentence : finding.sentences) out << sentence << '\n';
  }
  print_failures(out, runs, all);
  for (const json& plugin : document.at("context").value("plugins", json::array()))
    for (const std::string solver : plugin.at("solvers"))
      out << "\nplug-in " << solver << ": " << plugin.at("version").get<std::string>() << '\n';
  print_noise(out, document);
  if (const std::string words = text(coverage_of(runs)); !words.empty())
    out << '\n' << words << '\n';
  if (!all)
    out << "\nall contestants: bench show " << file << " --all; a page with figures: bench report "
        << file << " --out report.html\n";
}

void print_outcomes(std::ostream& out, const json& document) {
  const json &counts = document.at("counts"), &steps = document.at("largest_steps");
  const Table differences = differences_in(document);
  out << counts.at("cells") << " hard cases and solvers, " << counts.at("new_differences")
      << " with a new difference; how they ended:\n";
  print_aligned(out, outcomes_in(document));
  if (!differences.rows.empty()) out << "\nnot as expected (expected -> ended):\n";
  for (const auto& row : differences.rows) out << row[1] << "\n    " << row[0] << '\n';
  if (steps.empty()) return;
  const auto scene_of = [](const json& entry) { return entry.at("scene").get<std::string>(); };
  const auto solver_of = [](const json& entry) { return entry.at("solver").get<std::string>(); };
  Table table{{"solver"}};
  const auto scenes = in_order(steps, scene_of);
  table.head.insert(table.head.end(), scenes.begin(), scenes.end());
  for (const auto& [solver, own] : grouped(steps, solver_of)) {
    table.rows.push_back({solver});
    for (const std::string& scene : scenes) {
      const auto at = std::ranges::find(own, scene, scene_of);
      table.rows.back().push_back(at == own.end() ? "" : step_text(number_of(at->at("step"))));
    }
  }
  out << "\nlargest step (s) at which one second is survived, strain limit 1 %:\n";
  print_aligned(out, table);
}

}  // namespace harness
