// What solvers make of figures that theory knows: a row an answer. `bench show` has each solver.
#include <algorithm>
#include <cmath>

#include "harness/analysis/words.h"
#include "harness/base/fields_json.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/tables/page.h"

namespace harness::tables {

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

}  // namespace harness::tables
