#include "harness/stability/stability.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"
#include "harness/points/result_file.h"
#include "harness/points/schema.h"
#include "harness/stability/trial_isolation.h"
#include "inextensible/registry.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr double told_energy_gain = 0.05;
constexpr int bisections = 3;  // between the first step that survives and the one above: to 9 %

const Expectation& expectation_of(const HardCase& hard_case, const std::string& solver) {
  return *std::find_if(hard_case.expectations.begin(), hard_case.expectations.end(),
                       [&](const Expectation& e) { return e.solvers.contains(solver); });
}

bool acceptable(const std::set<Outcome>& allowed, const TrialResult& result) {
  if (!allowed.contains(result.fixed)) return false;
  if (result.outcome == result.fixed || result.outcome == Outcome::survived_smaller) return true;
  return result.outcome == Outcome::timeout || allowed.contains(result.outcome);
}

// The largest step at which the scene's second is survived: down the powers of two to the first one
// that is, then bisection (on a logarithmic scale) against the one above.
LargestStep largest_step(const StabilityScene& scene, const std::string& solver,
                         std::uint64_t seed) {
  LargestStep found{scene.name, solver, unknown, unknown, ""};
  const auto survives = [&](double step) {
    const TrialResult result = run_isolated_trial(
        [&] {
          // Whole steps, so that a second is a second.
          Trial trial = scene.build(1 / std::round(1 / step));
          trial.timeout = 2;
          return trial;
        },
        solver, seed);
    if (result.fixed != Outcome::survived)
      found.detail = to_string(result.fixed) + (": " + result.detail);
    return result.fixed == Outcome::survived;
  };
  double high = unknown, low = scene.largest;
  while (low >= scene.smallest * (1 - 1e-9) && !survives(low)) {
    high = low;
    low /= 2;
  }
  if (low < scene.smallest * (1 - 1e-9)) {
    found.failing = high;
    return found;
  }
  for (int i = 0; i < bisections && std::isfinite(high); ++i) {
    const double middle = std::sqrt(low * high);
    (survives(middle) ? low : high) = middle;
  }
  found.step = 1 / std::round(1 / low);
  if (std::isfinite(high)) found.failing = 1 / std::round(1 / high);
  return found;
}

char letter(Outcome outcome) {
  switch (outcome) {
    case Outcome::survived:
      return 'S';
    case Outcome::survived_smaller:
      return 's';
    case Outcome::refused:
      return 'R';
    case Outcome::diverged:
      return 'D';
    case Outcome::wrong:
      return 'W';
    case Outcome::timeout:
      return 'T';
    case Outcome::crashed:
      return 'C';
  }
  return '?';
}

// "S", or "S6 R2" where a row's cases differ; ! where one was not expected.
std::string cell_text(const std::vector<const StabilityCell*>& cells) {
  std::map<char, int> counts;
  bool expected = true;
  double gain = 0;
  for (const StabilityCell* cell : cells) {
    if (cell->result.energy_gain > gain) gain = cell->result.energy_gain;  // false on NaN
    ++counts[letter(cell->result.outcome)];
    expected = expected && cell->expected;
  }
  std::string text;
  for (const char c : std::string("SsRTDWC")) {
    const auto place = counts.find(c);
    if (place == counts.end()) continue;
    if (!text.empty()) text += ' ';
    text += c;
    if (counts.size() > 1) text += std::to_string(place->second);
  }
  if (gain > told_energy_gain) {
    std::ostringstream energy;
    energy << " E" << std::setprecision(2) << gain;
    text += energy.str();
  }
  return text + (expected ? "" : " !");
}

// Keys in order of first appearance.
template <class Items, class Key>
std::vector<std::string> in_order(const Items& items, Key key) {
  std::vector<std::string> keys;
  for (const auto& item : items) {
    if (std::find(keys.begin(), keys.end(), key(item)) == keys.end()) keys.push_back(key(item));
  }
  return keys;
}

}  // namespace

std::set<Outcome> allowed_outcomes(const Expectation& expectation, const std::string& solver) {
  std::set<Outcome> allowed = expectation.allowed;
  if (!inextensible::is_built_in(solver) && allowed.contains(Outcome::survived))
    allowed.insert({Outcome::refused, Outcome::timeout});
  return allowed;
}

bool StabilityOutcome::as_expected() const {
  return std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.expected; });
}

StabilityOutcome run_stability(const std::vector<HardCase>& cases, const StabilityFilters& filters,
                               std::uint64_t seed, const StabilityEvents& events) {
  std::vector<std::string> solvers;
  for (const auto& backend : inextensible::backends()) {
    if (backend.contestant && (!filters.solver || std::regex_match(backend.name, *filters.solver)))
      solvers.emplace_back(backend.name);
  }
  const auto selected = [&](const std::string& name) {
    return !filters.hard_case || std::regex_search(name, *filters.hard_case);
  };
  std::vector<const HardCase*> chosen;
  for (const HardCase& c : cases) {
    if (selected(c.name) || selected(c.row)) chosen.push_back(&c);
  }
  std::vector<StabilityScene> scenes = stability_scenes();
  std::erase_if(scenes, [&](const auto& scene) { return !selected("largest step " + scene.name); });
  const bool freedom = selected("triangles");
  if (solvers.empty()) throw UsageError("no contestant matches --solver");
  if (chosen.empty() && scenes.empty())
    throw UsageError("no case matches --case (bench list cases names them)");

  StabilityOutcome outcome;
  const std::size_t all = chosen.size() * solvers.size();
  for (const HardCase* c : chosen) {
    for (const std::string& solver : solvers) {
      if (events.interrupted()) {
        outcome.complete = false;
        return outcome;
      }
      StabilityCell cell{
          c,  solver, run_isolated_trial(c->build, solver, seed), &expectation_of(*c, solver),
          {}, true};
      cell.allowed = allowed_outcomes(*cell.expectation, solver);
      cell.expected = acceptable(cell.allowed, cell.result);
      outcome.cells.push_back(std::move(cell));
      events.cell(outcome.cells.back(), outcome.cells.size(), all);
    }
  }
  for (const StabilityScene& scene : scenes) {
    for (const std::string& solver : solvers) {
      if (events.interrupted()) {
        outcome.complete = false;
        return outcome;
      }
      outcome.largest_steps.push_back(largest_step(scene, solver, seed));
      events.largest_step(outcome.largest_steps.back());
    }
  }
  if (freedom) {
    for (const int n : {11, 21, 41}) {
      for (const Freedom& f : degrees_of_freedom(n)) outcome.freedom.push_back(f);
    }
  }
  return outcome;
}

void print_stability(std::ostream& out, const StabilityOutcome& outcome) {
  constexpr int row_width = 26, cell_width = 17;
  const auto table = [&](const std::string& title, const std::vector<std::string>& rows,
                         const std::vector<std::string>& columns, auto text) {
    if (rows.empty()) return;
    out << '\n' << title << '\n' << std::left << std::setw(row_width) << "";
    for (const auto& column : columns)
      out << std::setw(std::max(cell_width, int(column.size()) + 2)) << column;
    out << '\n';
    for (const auto& row : rows) {
      out << std::setw(row_width) << row;
      for (const auto& column : columns)
        out << std::setw(std::max(cell_width, int(column.size()) + 2)) << text(row, column);
      out << '\n';
    }
  };
  table(
      "S survived, s survived with smaller steps, R refused cleanly, T timed out, D diverged, W "
      "wrong, E energy gained (over its scale), ! not as expected",
      in_order(outcome.cells, [](const auto& c) { return c.hard_case->row; }),
      in_order(outcome.cells, [](const auto& c) { return c.solver; }),
      [&](const std::string& row, const std::string& solver) {
        std::vector<const StabilityCell*> cells;
        for (const auto& cell : outcome.cells) {
          if (cell.hard_case->row == row && cell.solver == solver) cells.push_back(&cell);
        }
        return cell_text(cells);
      });
  table("largest step (s) at which one second is survived, strain limit 1 % (springs: without one)",
        in_order(outcome.largest_steps, [](const auto& s) { return s.scene; }),
        in_order(outcome.largest_steps, [](const auto& s) { return s.solver; }),
        [&](const std::string& scene, const std::string& solver) -> std::string {
          for (const auto& s : outcome.largest_steps) {
            if (s.scene == scene && s.solver == solver) return step_text(s.step);
          }
          return "";
        });
  if (!outcome.freedom.empty()) {
    out << "\ndegrees of freedom left (3 per vertex less the rank of J)\n";
    for (const auto& f : outcome.freedom) {
      out << "  " << std::setw(10) << f.mesh << f.vertices << " vertices, " << f.constraints
          << " constraints, rank " << f.rank << ": " << f.degrees_of_freedom << " left, "
          << std::setprecision(3) << static_cast<double>(f.degrees_of_freedom) / f.vertices
          << " a vertex\n";
    }
  }
  bool heading = false;
  for (const auto& cell : outcome.cells) {
    if (cell.expected) continue;
    if (!heading) out << "\nnot as expected:\n";
    heading = true;
    out << "  " << cell.hard_case->name << ", " << cell.solver << ": "
        << to_string(cell.result.outcome);
    if (cell.result.fixed != cell.result.outcome)
      out << " (" << to_string(cell.result.fixed) << ")";
    out << ", " << cell.result.detail << '\n';
  }
}

json stability_document(json context, const StabilityOutcome& outcome, std::uint64_t seed,
                        const std::vector<std::string>& command) {
  context["command"] = command;
  context["seed"] = seed;
  json matrix = json::array(), steps = json::array(), freedom = json::array();
  for (const auto& cell : outcome.cells) {
    const TrialResult& r = cell.result;
    json allowed = json::array();
    for (const Outcome o : cell.allowed) allowed.push_back(to_string(o));
    matrix.push_back({{"row", cell.hard_case->row},
                      {"case", cell.hard_case->name},
                      {"what", cell.hard_case->what},
                      {"solver", cell.solver},
                      {"outcome", to_string(r.outcome)},
                      {"at_fixed_step", to_string(r.fixed)},
                      {"allowed_at_fixed_step", allowed},
                      {"why", cell.expectation->why},
                      {"as_expected", cell.expected},
                      {"detail", r.detail},
                      {"smallest_step", number(r.smallest_step)},
                      {"max_strain", number(r.max_strain)},
                      {"energy_gain", number(r.energy_gain)},
                      {"momentum_defect", number(r.momentum_defect)},
                      {"reciprocal_condition", number(r.reciprocal_condition)},
                      {"seconds", r.seconds},
                      {"work", to_json(r.work)}});
  }
  for (const auto& s : outcome.largest_steps) {
    steps.push_back({{"scene", s.scene},
                     {"solver", s.solver},
                     {"step", number(s.step)},
                     {"failing_step", number(s.failing)},
                     {"detail", s.detail}});
  }
  for (const auto& f : outcome.freedom) {
    freedom.push_back({{"mesh", f.mesh},
                       {"vertices", f.vertices},
                       {"constraints", f.constraints},
                       {"rank", f.rank},
                       {"degrees_of_freedom", f.degrees_of_freedom}});
  }
  return {{"schema", "inextensible-stability/1"},
          {"complete", outcome.complete},
          {"context", context},
          {"legend", legend()},
          {"matrix", matrix},
          {"largest_steps", steps},
          {"degrees_of_freedom", freedom}};
}

}  // namespace harness
