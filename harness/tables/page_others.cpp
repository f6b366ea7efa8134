// Tables of growth, sag, slip, known answers and hard cases, and of the files themselves.
#include <algorithm>
#include <array>
#include <cmath>

#include "harness/analysis/growth.h"
#include "harness/analysis/words.h"
#include "harness/base/fields_json.h"
#include "harness/base/in_order.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/claims/judging.h"
#include "harness/tables/page.h"

namespace harness::tables {
namespace {

// "1.13 (1.05 to 1.21), to 5041: 12.4 ms".
std::string cell_text(const std::vector<RowGrowth>& rows, const std::string& name) {
  for (const RowGrowth& row : rows) {
    if (row.row == name)
      return exponent_words(row.exponent) + "; " +
             time_words(row.largest.seconds() * row.largest.number("step")) + " at " +
             number_text(row.largest.number("vertices"), 7);
  }
  return "-";
}

}  // namespace

void print_growth(std::ostream& out, const std::vector<NamedResult>& results) {
  std::vector<Growth> all;
  for (const NamedResult& result : results) {
    if (is_stability(result.document)) continue;
    for (Growth& growth : growth_in(planes_of(result.document))) all.push_back(std::move(growth));
  }
  if (all.empty()) return;
  out << "## Growth\n\nThe time of a step, whatever the motion, grows as the number of vertices to "
         "this power (95 % interval); and what a step takes at the largest size.\n\n";
  std::vector<std::string> row{"solver"}, names;
  for (const Growth& growth : all) {
    row.push_back(scene_words(growth.scene) + " at " + percent(growth.strain_limit) + ", from " +
                  number_text(growth.rows.front().smallest.number("vertices"), 7));
    for (const RowGrowth& each : growth.rows) names.push_back(each.row);
  }
  print_head(out, row);
  for (const std::string& name : in_order(names, [](const std::string& text) { return text; })) {
    row = {quoted(name)};
    for (const Growth& growth : all) row.push_back(cell_text(growth.rows, name));
    print_row(out, row);
  }
  out << '\n';
}

// How far marked vertices sag.

void print_sag(std::ostream& out, const NamedResult& result) {
  const LimitTable table(result.document, "hung_patch");
  if (table.empty()) return;
  const double side = table.any().scene_parameter("side");
  out << "## Sag of the hung patch (`" << result.name << "`)\n\n"
      << "How far the middle of the top row, and that of the lower edge, hang below where they "
         "would if nothing stretched, mean over the last third of the run, each solver at its "
         "best step; in brackets how fast it still moves. A top row that "
         "uses up its strain and bears an even load is a parabola, which sags by ";
  bool first = true;
  for (const double limit : table.limits()) {
    out << (first ? "" : ", ") << plain(1e3 * claims::parabola_sag(side, limit), 3) << " mm at "
        << percent(limit);
    first = false;
  }
  out << ".\n\n";
  table.print(
      out, [](double limit) { return percent(limit) + ", mm (m/s)"; },
      [](const Point& p) {
        const nlohmann::json& sag = p.document().at("sag");
        return plain(1e3 * sag.at("top_row").get<double>(), 3) + ", " +
               plain(1e3 * sag.at("lower_edge").get<double>(), 3) + " (" +
               plain(p.number("rest_speed"), 2) + ")";
      });
}

// Where the rim of a garment ends up.

namespace {

constexpr double frame = 1.0 / 30;  // s

}  // namespace

void print_slip(std::ostream& out, const NamedResult& result) {
  const LimitTable table(result.document, "garment");
  if (table.empty()) return;
  out << "## Slip of the garment (`" << result.name
      << "`)\n\nHow far the garment's rim is below the waist, where it began, mean over the last "
         "third of the run, of the way to the hips: above 100 % it has slipped past them. In "
         "brackets the time of computation for a frame of 1/30 s. Each solver at its best "
         "step.\n\n";
  table.print(
      out, [](double limit) { return percent(limit) + ", % (s)"; },
      [](const Point& p) {
        const claims::Slip slip = claims::slip_of(p);
        return plain(50 * (slip.least + slip.most), 3) + " (" + plain(frame * p.seconds(), 2) + ")";
      });
}

// What solvers make of figures that theory knows: a row an answer. `bench show` has each solver.

using nlohmann::json;

namespace {

// What one solver gave at the finest step that it finished.
struct Given {
  std::string solver;
  double step = 0, value = 0, deviation = 0, order = 0;
};

std::vector<Given> finest_of(const json& document, const std::string& answer) {
  std::vector<Given> all;
  for (const json& row : document.at("rows")) {
    const double value = number_of(row.at("value")), step = row.at("step");
    if (row.at("answer") != answer || !std::isfinite(value)) continue;
    const Given given{row.at("solver"), step, value, std::abs(number_of(row.at("deviation"))),
                      number_of(row.at("order"))};
    const auto same = std::find_if(
        all.begin(), all.end(), [&](const Given& other) { return other.solver == given.solver; });
    if (same == all.end()) {
      all.push_back(given);
    } else if (given.step < same->step) {
      *same = given;
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Given& a, const Given& b) { return a.deviation < b.deviation; });
  return all;
}

std::string given_words(const Given& given, double exact) {
  return plain(given.value, exact == 0 ? 2 : 4) + ", " + quoted(given.solver);
}

std::string order_words(const std::vector<Given>& all) {
  std::vector<double> orders;
  for (const Given& given : all) {
    if (std::isfinite(given.order)) orders.push_back(given.order);
  }
  return orders.empty() ? "-" : number_text(quantile(orders, 0.5), 2);
}

}  // namespace

void print_answers(std::ostream& out, const NamedResult& result) {
  out << "## Known answers (`" << result.name
      << "`)\n\nScenes whose answer theory or measurement gives, by each solver at its default "
         "settings and the finest step that it finished: how many solvers finished, and the "
         "nearest and the farthest of their values. Order: the median of the orders in the step. "
         "`bench list answers` has the sources, `bench show "
      << result.name << "` every solver and step.\n\n";
  print_head(
      out, {"answer", "scene, strain limit", "exact", "finished", "nearest", "farthest", "order"});
  for (const json& answer : result.document.at("answers")) {
    const double exact = answer.at("exact");
    const auto all = finest_of(result.document, answer.at("name"));
    const bool any = !all.empty();
    print_row(out, {quoted(answer.at("name")),
                    quoted(answer.at("scene")) + ", " + percent(answer.at("strain_limit")),
                    number_text(exact, 6), std::to_string(all.size()),
                    any ? given_words(all.front(), exact) : "-",
                    any ? given_words(all.back(), exact) : "-", order_words(all)});
  }
  out << '\n';
}

using nlohmann::json;

namespace {

// What did not end as theory expects, with the reason where one is known.
void print_differences(std::ostream& out, const json& document) {
  std::vector<std::vector<std::string>> rows;
  for (const json& cell : document.at("matrix")) {
    if (cell.at("as_expected")) continue;
    std::string reason = "not known: " + cell.at("detail").get<std::string>();
    for (const json& known : document.at("known_differences")) {
      if (cell.at("known_difference") && known.at("case") == cell.at("case") &&
          known.at("solver") == cell.at("solver"))
        reason = known.at("reason").get<std::string>() +
                 "; would fix it: " + known.at("mends").get<std::string>();
    }
    const std::string fixed = cell.at("at_fixed_step"), outcome = cell.at("outcome");
    rows.push_back({quoted(cell.at("case")), quoted(cell.at("solver")),
                    cell.at("expected_at_fixed_step"),
                    fixed == outcome ? fixed : fixed + ", with smaller steps " + outcome, reason});
  }
  if (rows.empty()) return;
  print_head(out, {"case", "solver", "expected", "ended", "why"});
  for (const auto& row : rows) print_row(out, row);
  out << '\n';
}

}  // namespace

void print_hard_cases(std::ostream& out, const NamedResult& result) {
  if (!is_stability(result.document)) return;
  constexpr std::array outcomes{"survived", "survived_smaller", "refused", "diverged",
                                "wrong",    "timeout",          "crashed"};
  std::vector<std::string> solvers;
  std::map<std::string, std::map<std::string, int>> count;
  for (const json& cell : result.document.at("matrix")) {
    const std::string solver = cell.at("solver");
    if (!count.contains(solver)) solvers.push_back(solver);
    ++count[solver][cell.at("outcome")];
  }
  const json& counts = result.document.at("counts");
  out << "## Hard cases (`" << result.name << "`)\n\n"
      << "How each solver ends in small scenes that are known to break solvers; what the outcomes "
         "mean is in [measuring.md](measuring.md#hard-cases). Of "
      << counts.at("cells") << " cells, " << counts.at("strict") << " have one expected outcome, "
      << counts.at("two_admitted")
      << " admit two where theory cannot decide. Not as expected: " << counts.at("not_as_expected")
      << ".\n\n";
  std::vector<std::string> row{"solver"};
  for (const char* outcome : outcomes) row.push_back(std::string(outcome) + ", cases");
  print_head(out, row);
  for (const std::string& solver : solvers) {
    row = {quoted(solver)};
    for (const char* outcome : outcomes) row.push_back(std::to_string(count[solver][outcome]));
    print_row(out, row);
  }
  out << '\n';
  print_differences(out, result.document);
}

// What the result files say of themselves: date, machine, commit and noise.

using nlohmann::json;

namespace {

// Excess of the longer time over the shorter one, from |log ratio|.
std::string noise_cell(const json& noise, const char* key) {
  return noise.is_object() && noise.contains(key) && noise.at(key).is_number()
             ? percent(std::expm1(noise.at(key).get<double>()))
             : std::string("-");
}

}  // namespace

void print_sources(std::ostream& out, const std::vector<NamedResult>& results) {
  out << "A/A: how far apart the times of one solver under two names are, in half of all places at "
         "most and in 95 % of them.\n\n";
  print_head(out, {"file", "date", "processor", "commit", "A/A pair", "places", "half", "95 %"});
  for (const NamedResult& result : results) {
    const json context = result.document.value("context", json::object());
    const json noise = context.value("noise", json());
    const bool pair = noise.is_object() && noise.contains("pair");
    const auto word = [](const json& object, const char* key) { return object.value(key, "-"); };
    print_row(out, {quoted(result.name), word(context, "date"), word(context, "cpu_model"),
                    word(context.value("build", json::object()), "git"),
                    pair ? quoted(noise.at("pair").at(0)) : std::string("-"),
                    pair ? std::to_string(noise.value("places", 0)) : std::string("-"),
                    noise_cell(noise, "median"), noise_cell(noise, "q95")});
  }
}

}  // namespace harness::tables
