#include <iterator>

#include "harness/claims/claims.h"
#include "harness/points/contestant.h"
#include "harness/tables/tables.h"

namespace harness {

using namespace analysis;  // tables print what was analysed

namespace {

std::string quoted(const std::string& name) { return '`' + name + '`'; }

// number_text(), but large numbers are written out rather than with a power of ten.
std::string plain(double value, int digits) {
  const bool large = value >= 1 && std::isfinite(value);
  return number_text(value, std::max(digits, large ? static_cast<int>(std::log10(value)) + 1 : 1));
}

std::string solver_of(const json& entry) { return entry.at("solver"); }

void print_table(std::ostream& out, const std::string& introduction, const Table& table) {
  out << introduction << ".\n\n";
  print_markdown(out, table);
  out << '\n';
}

// ---- Planes: the fastest within each strain limit and level of error ----

// "`yarn_projection` 8.1 ms, 1/100 s, 1.7 (1.5-1.8) `icd`": bold if it is ahead beyond the noise.
std::string cell_text(const Cell& cell) {
  const Entry* first = cell.first();
  if (!first) return cell.empty_because;
  const std::string name = quoted(first->row) + (first->role.unranked ? " `u`" : "");
  std::string text = (cell.clear() ? "**" + name + "**" : name) + " " +
                     plain(1e3 * first->point.seconds(), 3) + " ms, " +
                     step_text(first->point.step());
  if (const double kept = first->point.strain_limit(); kept < cell.strain_limit)
    text += " at " + percent(kept);
  if (cell.level == any_motion && std::isfinite(first->error))
    text += ", off by " + number_text(100 * first->error, 2) + " %";
  if (const Entry* paper = cell.rival(Rival::paper_best); paper && paper != first)
    text += "; " + analysis::text(*cell.lead_over(paper)) + " " + quoted(paper->row);
  return text;
}

// "1.7 (1.5-1.8) `icd`": a rival's time over the first's.
std::string lead_text(const Cell& cell, Rival which) {
  const Entry* other = cell.rival(which);
  if (!other) return "-";
  return other == cell.first() ? "itself"
                               : analysis::text(*cell.lead_over(other)) + " " + quoted(other->row);
}

// Who is fastest at the headline's limit and error, and how much of that is stepper or method; then
// at every limit and error, except for step sweeps, which have figures.
void print_planes(std::ostream& out, const std::vector<Plane>& planes) {
  Table answers{
      {"scene, vertices", "strain", "error", "known to", "fastest", "its method as published",
       "next method in its stepper", "paper's six in any stepper"},
      {},
      0},
      grid{{"scene, vertices, sweep", "strain"}, {}, 0};
  for (const double level : planes.front().levels)
    grid.head.push_back(level == any_motion ? "any motion" : "error <= " + percent(level));
  for (const Plane& plane : planes) {
    const std::string place = scene_words(plane.scene) + ", " + std::to_string(plane.vertices);
    for (const Cell& cell : plane.cells) {  // by limit, then by level
      if (plane.sweep == "step") break;
      if (cell.level == plane.levels.front())
        grid.rows.push_back({place + ", " + plane.sweep, percent(cell.strain_limit)});
      grid.rows.back().push_back(cell_text(cell));
    }
    const Cell& cell = headline_of(plane);
    if (!cell.first() || !is_largest(plane, planes)) continue;
    answers.rows.push_back(
        {place, percent(cell.strain_limit), cell.level == any_motion ? "any" : percent(cell.level),
         cell.known_until > 0 ? number_text(cell.known_until) + " s" : "-", cell_text(cell)});
    for (const Rival which :
         {Rival::first_as_published, Rival::rival_in_stepper, Rival::paper_in_any_stepper})
      answers.rows.back().push_back(lead_text(cell, which));
  }
  print_table(
      out,
      "## Who is fastest\n\nIn each cell the fastest: its time for one simulated second and its "
      "step in s; then how many times as long the best of the paper's six takes, if it is not of "
      "them. Bold: faster than each other one beyond the noise. `u`: with settings other than its "
      "tuned ones. Errors are over the scene's size, up to the time to which the references agree. "
      "The last three columns say where the lead comes from, in times the leader's time",
      answers);
  out << "### Fastest within each strain and error\n\n";
  print_markdown(out, grid);
  out << '\n';
}

// What the page's planes are of: of a scene and size that a sweep over strain has too, steps are
// for figures. Runs in the paper's order of collision are claims' evidence, and no contest.
std::vector<Plane> shown_planes(const std::vector<json>& sweeps) {
  const std::vector<Plane> planes = planes_of(Runs(joined(sweeps)));
  std::vector<Plane> shown;
  std::ranges::copy_if(planes, std::back_inserter(shown), [&](const Plane& plane) {
    return !plane.points.front().collides_last() &&
           std::ranges::any_of(plane.cells, [](const Cell& cell) { return cell.counting(1); }) &&
           (plane.sweep != "step" || std::ranges::none_of(planes, [&](const Plane& other) {
              return other.sweep == "strain" && other.scene == plane.scene &&
                     other.vertices == plane.vertices;
            }));
  });
  return shown;
}

// How far marked vertices hang below where they would if nothing stretched, in scenes that have
// some.
void print_sags(std::ostream& out, const NamedResult& result) {
  const Runs runs(result.document);
  std::vector<Point> fastest;
  std::ranges::copy_if(runs.points, std::back_inserter(fastest), [&](const Point& p) {
    return p.sweep() == "strain" && p.ok() && p.result().best && !p.measures().sag.empty() &&
           runs.roles.of(p.contestant()).ranked();
  });
  std::ranges::stable_sort(fastest, std::greater(), &Point::strain_limit);
  for (const auto& [scene, points] : grouped(fastest, &Point::scene)) {
    std::string marks;
    for (const auto& [name, sag] : points.front().measures().sag) append(marks, quoted(name));
    Table table{{"solver"}};
    const std::vector<double> limits = in_order(points, std::mem_fn(&Point::strain_limit));
    for (const double limit : limits) table.head.push_back(percent(limit) + ", mm (m/s)");
    for (const auto& [solver, own] : grouped(points, &Point::contestant)) {
      auto& row = table.rows.emplace_back(1 + limits.size(), "-");
      row[0] = solver;
      for (const Point& p : own) {
        std::string sags;
        for (const auto& [name, sag] : p.measures().sag) append(sags, plain(1e3 * sag, 3));
        row[1 + std::ranges::find(limits, p.strain_limit()) - limits.begin()] =
            sags + " (" + plain(p.measures().rest_speed, 2) + ")";
      }
    }
    print_table(
        out,
        "## Sag of " + scene_words(scene) + " (`" + result.name + "`)\n\nHow far " + marks +
            " hang below where they would if nothing stretched, mean over the last third of the "
            "run, each solver at its best step; in brackets how fast the cloth still moves",
        table);
  }
}

// One row per known answer, from the finest step that each solver finished.
void print_answers(std::ostream& out, const NamedResult& result) {
  Table table{
      {"answer", "scene, strain limit", "exact", "finished", "nearest", "farthest", "order"}, {}};
  const json& rows = result.document.at("rows");
  for (const json& answer : result.document.at("answers")) {
    std::vector<json> finished, given;
    std::ranges::copy_if(rows, std::back_inserter(finished), [&answer](const json& row) {
      return row.at("answer") == answer.at("name") && !row.at("value").is_null();
    });
    for (const auto& [solver, own] : grouped(finished, solver_of))
      given.push_back(
          std::ranges::min(own, {}, [](const json& row) { return row.at("step").get<double>(); }));
    std::ranges::stable_sort(
        given, {}, [](const json& row) { return std::abs(number_of(row.at("deviation"))); });
    std::vector<double> orders;
    for (const json& row : given)
      if (!row.at("order").is_null()) orders.push_back(row.at("order"));
    const double exact = answer.at("exact");
    const auto words = [&](const json& row) {
      return plain(row.at("value"), exact == 0 ? 2 : 4) + ", " + quoted(row.at("solver"));
    };
    table.rows.push_back(
        {answer.at("name"), quoted(answer.at("scene")) + ", " + percent(answer.at("strain_limit")),
         number_text(exact, 6), std::to_string(given.size()),
         given.empty() ? "-" : words(given.front()), given.empty() ? "-" : words(given.back()),
         orders.empty() ? "-" : number_text(quantile(orders, 0.5), 2)});
  }
  print_table(out,
              "## Known answers (`" + result.name +
                  "`)\n\nScenes whose answer theory or measurement gives, by each solver at its "
                  "default settings and the finest step that it finished: how many solvers "
                  "finished, and the nearest and the farthest of their values. Order: the median "
                  "of the orders in the step. `bench list answers` has the sources, `bench show " +
                  result.name + "` every solver and step",
              table);
}

void print_hard_cases(std::ostream& out, const NamedResult& result) {
  const json& counts = result.document.at("counts");
  print_table(out,
              "## Hard cases (`" + result.name +
                  "`)\n\nHow many small scenes that are known to break solvers end in which way by "
                  "each solver; [measuring.md](measuring.md#hard-cases) explains them. Of " +
                  counts.at("cells").dump() + " cells, " + counts.at("strict").dump() +
                  " have one expected outcome, " + counts.at("two_admitted").dump() +
                  " admit two where theory cannot decide. Not as expected: " +
                  counts.at("not_as_expected").dump(),
              outcomes_in(result.document));
  const Table differences = differences_in(result.document);
  if (differences.rows.empty()) return;
  print_markdown(out, differences);
  out << '\n';
}

void print_sources(std::ostream& out, const std::vector<NamedResult>& results) {
  Table table{
      {"file", "date", "processors", "commit", "A/A", "places", "occasions", "scatter", "outside"}};
  for (const NamedResult& result : results) {
    const json& context = result.document.at("context");
    std::string processors = context.at("cpu_model");
    for (const json& occasion : context.value("occasions", json::array()))
      if (const std::string other = occasion.at("cpu_model"); processors.find(other) == other.npos)
        append(processors, other);
    std::vector<std::string> row{result.name, context.at("date").get<std::string>().substr(0, 16),
                                 processors,
                                 context.at("build").at("git").get<std::string>().substr(0, 12)};
    if (const auto noise = noise_of(context)) {
      // Excess of the longer time over the shorter one, from |log ratio|.
      row.insert(row.end(), {percent(std::expm1(noise->q95)), std::to_string(noise->places)});
    }
    if (const json scatter = context.value("scatter", json()); scatter.is_number()) {
      const Coverage coverage = coverage_of(result.document);
      row.resize(6, "-");
      row.insert(row.end(), {std::to_string(coverage.occasions), percent(scatter)});
      if (coverage.ratios > 0)
        row.push_back(percent(static_cast<double>(coverage.outside) / coverage.ratios) + " of " +
                      std::to_string(coverage.ratios));
    }
    row.resize(table.head.size(), "-");
    table.rows.push_back(std::move(row));
  }
  out << "## Where these numbers come from\n\nA/A: how far apart the times of one solver under two "
         "names are, in 95 % of all places. Intervals come from the scatter (standard deviation) "
         "of ratios of two times between occasions, hours apart; outside: how many ratios of one "
         "occasion lie outside the interval that the others give. With a single occasion, "
         "intervals are those of its samples, and say nothing of another day.\n\n";
  print_markdown(out, table);
}

}  // namespace

Table outcomes_in(const json& document) {
  constexpr std::array outcomes{"survived", "survived_smaller", "refused", "diverged",
                                "wrong",    "timeout",          "crashed"};
  const json& matrix = document.at("matrix");
  std::map<std::string, std::map<std::string, int>> count;
  for (const json& cell : matrix) ++count[cell.at("solver")][cell.at("outcome")];
  Table table{{"solver"}};
  table.head.insert(table.head.end(), outcomes.begin(), outcomes.end());
  // A row for each method, with the counts of its steppers.
  std::string method;
  for (const std::string& solver : in_order(matrix, solver_of)) {
    const bool next = method_of(solver) != method;
    method = method_of(solver);
    if (next) table.rows.emplace_back(table.head.size());
    std::size_t column = 0;
    const auto add = [&](const std::string& text) {
      std::string& cell = table.rows.back()[column++];
      if (!next) cell += ", ";
      cell += text;
    };
    add(next ? solver : solver.substr(method.size()));
    for (const char* outcome : outcomes) add(std::to_string(count[solver][outcome]));
  }
  return table;
}

Table differences_in(const json& document) {
  std::map<std::string, std::map<std::string, std::string>> places;  // by reason, then by ending
  for (const json& cell : document.at("matrix")) {
    if (cell.at("as_expected")) continue;
    std::string reason = "not known: " + cell.at("detail").get<std::string>();
    for (const json& known : document.at("known_differences"))
      if (cell.at("known_difference") && known.at("case") == cell.at("case") &&
          known.at("solver") == cell.at("solver"))
        reason = known.at("reason").get<std::string>() +
                 "; would fix it: " + known.at("mends").get<std::string>();
    const std::string fixed = cell.at("at_fixed_step"), outcome = cell.at("outcome"),
                      expected = cell.at("expected_at_fixed_step"),
                      ending = expected + " -> " + fixed +
                               (fixed == outcome ? "" : ", with smaller steps " + outcome),
                      solver = cell.at("solver"), name = cell.at("case");
    append(places[reason][ending], solver + " in " + name);
  }
  Table table{{"why", "expected -> ended: solver in case"}, {}, 0};
  for (const auto& [reason, endings] : places) {
    table.rows.push_back({reason, ""});
    for (const auto& [ending, list] : endings)
      append(table.rows.back()[1], concat(ending, ": ", list), "; ");
  }
  return table;
}

void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& answers) try {
  std::vector<NamedResult> all = results;
  all.insert(all.end(), answers.begin(), answers.end());
  const auto is_hard = [](const NamedResult& result) { return result.document.contains("matrix"); };
  std::vector<json> documents, sweeps;
  for (const NamedResult& result : results) {
    documents.push_back(result.document);
    if (!is_hard(result)) sweeps.push_back(result.document);
  }

  if (const auto planes = shown_planes(sweeps); !planes.empty()) print_planes(out, planes);
  out << "## The paper's claims (`bench claims` gives each rule)\n\n";
  print_claims_markdown(out, judge_claims(documents));
  out << '\n';
  for (const NamedResult& result : results)
    if (!is_hard(result)) print_sags(out, result);
  for (const NamedResult& result : answers) print_answers(out, result);
  for (const NamedResult& result : results)
    if (is_hard(result)) print_hard_cases(out, result);
  print_sources(out, all);
} catch (const json::exception& error) {
  throw UsageError(std::string("a result file is incomplete: ") + error.what());
}

}  // namespace harness
