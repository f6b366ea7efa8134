#include "harness/claims/results_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "harness/base/errors.h"
#include "harness/base/fit.h"
#include "harness/base/text.h"
#include "harness/claims/claims.h"

namespace harness {
namespace {

using nlohmann::json;

// Points of one scene, size and sweep of one file, in the file's order.
using Points = std::vector<const json*>;

double median_seconds(const json& point) {
  return point.at("seconds_per_simulated_second").at("median").get<double>();
}

double number(const json& value) { return value.is_number() ? value.get<double>() : std::nan(""); }

// As number_text(), but never with a power of ten where the number has more digits.
std::string plain(double value, int digits) {
  const int whole = value >= 1 ? static_cast<int>(std::log10(value)) + 1 : 1;
  return number_text(value, std::max(digits, whole));
}

// Who competes; older files have solvers only.
std::string name_of(const json& point) {
  return point.contains("contestant") ? point.at("contestant") : point.at("solver");
}

bool is_stability(const json& document) { return document.contains("matrix"); }

// sizes_apart: points of each resolution by themselves.
std::map<std::string, Points> scenes_of(const json& document, const std::string& sweep,
                                        bool sizes_apart) {
  std::map<std::string, Points> scenes;
  if (is_stability(document)) return scenes;
  for (const json& p : document.at("points")) {
    if (p.at("sweep") != sweep || p.value("adaptive", false)) continue;
    std::string name = p.at("scene").get<std::string>();
    if (sizes_apart) name += ", " + std::to_string(p.at("vertices").get<int>()) + " vertices";
    scenes[name].push_back(&p);
  }
  return scenes;
}

std::vector<std::string> solvers_of(const Points& points) {
  std::vector<std::string> solvers;
  for (const json* p : points) {
    const std::string solver = name_of(*p);
    if (std::find(solvers.begin(), solvers.end(), solver) == solvers.end())
      solvers.push_back(solver);
  }
  return solvers;
}

void print_row(std::ostream& out, const std::vector<std::string>& cells) {
  out << '|';
  for (const std::string& cell : cells) out << ' ' << cell << " |";
  out << '\n';
}

void print_head(std::ostream& out, const std::vector<std::string>& cells) {
  print_row(out, cells);
  out << '|';
  for (std::size_t i = 0; i < cells.size(); ++i) out << "---|";
  out << '\n';
}

std::string quoted(const std::string& name) { return '`' + name + '`'; }

// Best points over the axis of a strain or resolution sweep.
class BestPoints {
 public:
  BestPoints(const Points& points, const char* axis) : solvers_(solvers_of(points)) {
    for (const json* p : points) {
      if (!p->at("best").get<bool>() || p->at("status") != "ok") continue;
      const double at = p->at(axis);
      if (std::find(places_.begin(), places_.end(), at) == places_.end()) places_.push_back(at);
      best_[{name_of(*p), at}] = p;
    }
    std::sort(places_.begin(), places_.end());
  }

  void loose_to_tight() { std::reverse(places_.begin(), places_.end()); }

  // A table with a row for each solver; cell: the text of a point, given that of fast projection.
  void print(std::ostream& out, const std::function<std::string(double)>& head,
             const std::function<std::string(const json&, const json*)>& cell) const {
    std::vector<std::string> row{"solver"};
    for (const double at : places_) row.push_back(head(at));
    print_head(out, row);
    for (const std::string& solver : solvers_) {
      row = {quoted(solver)};
      for (const double at : places_) {
        const json* point = find(solver, at);
        row.push_back(point ? cell(*point, find("fast_projection", at)) : "-");
      }
      print_row(out, row);
    }
    out << '\n';
  }

  const std::vector<double>& places() const { return places_; }
  const std::vector<std::string>& solvers() const { return solvers_; }
  const json* find(const std::string& solver, double at) const {
    const auto place = best_.find({solver, at});
    return place == best_.end() ? nullptr : place->second;
  }

 private:
  std::vector<std::string> solvers_;
  std::vector<double> places_;
  std::map<std::pair<std::string, double>, const json*> best_;
};

std::string percent(double fraction) { return number_text(100 * fraction, 3) + " %"; }

void print_best(std::ostream& out, const NamedResult& result, const std::string& sweep) {
  const bool strain = sweep == "strain";
  for (const auto& [scene, points] : scenes_of(result.document, sweep, strain)) {
    BestPoints best(points, strain ? "strain_limit" : "vertices");
    if (best.places().empty()) continue;
    if (strain) best.loose_to_tight();
    const auto place = [&](double at) {
      return strain ? percent(at) : number_text(at, 7) + " vertices";
    };
    out << "### " << scene << " (`" << result.name << "`)\n\n"
        << "Seconds of computation for one simulated second, each solver at its best step:\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", s"; },
        [](const json& p, const json*) { return plain(median_seconds(p), 3); });
    out << "The same, over the time of fast projection (above 1: slower):\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", ratio"; },
        [](const json& p, const json* fast) {
          return fast ? plain(median_seconds(p) / median_seconds(*fast), 2) : std::string("-");
        });
    out << "The steps these are:\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", step in s"; },
        [](const json& p, const json*) { return step_text(p.at("step")); });
  }
}

void print_time_to_error(std::ostream& out, const NamedResult& result) {
  constexpr std::array targets{0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001};
  for (const auto& [scene, points] : scenes_of(result.document, "step", true)) {
    double gap = 0, valid_until = std::nan("");
    for (const json* p : points) {
      const json& error = p->at("error");
      if (error.at("gap").is_number()) gap = std::max(gap, number(error.at("gap")));
      if (error.at("valid_until").is_number()) valid_until = number(error.at("valid_until"));
    }
    // Without a reference, or a rival, there is nothing to compare.
    if (std::isnan(valid_until) || solvers_of(points).size() < 2) continue;
    out << "### " << scene << " (`" << result.name << "`)\n\n"
        << "Least time for one simulated second to stay within an error, and the step that does "
           "it, "
           "at any strain limit. Errors are root mean squares over the scene's size, up to "
        << number_text(valid_until, 3) << " s; the reference is sure to " << percent(3 * gap)
        << ".\n\n";
    std::vector<std::string> row{"solver"};
    for (const double target : targets) {
      if (target >= 3 * gap) row.push_back(percent(target) + ": time in ms, step in s");
    }
    print_head(out, row);
    for (const std::string& solver : solvers_of(points)) {
      row = {quoted(solver)};
      for (const double target : targets) {
        if (target < 3 * gap) continue;
        const json* fastest = nullptr;
        for (const json* p : points) {
          const bool fits = name_of(*p) == solver && p->at("status") == "ok" &&
                            number(p->at("error").at("trajectory")) <= target;
          if (fits && (!fastest || median_seconds(*p) < median_seconds(*fastest))) fastest = p;
        }
        row.push_back(fastest ? plain(1e3 * median_seconds(*fastest), 3) + ", " +
                                    step_text(fastest->at("step"))
                              : "-");
      }
      print_row(out, row);
    }
    out << '\n';
  }
}

void print_growth(std::ostream& out, const NamedResult& result) {
  for (const auto& [scene, points] : scenes_of(result.document, "resolution", false)) {
    const BestPoints best(points, "vertices");
    out << "### " << scene << " (`" << result.name << "`)\n\n";
    print_head(out, {"solver", "sizes, vertices", "exponent (95 % interval)",
                     "a step at the largest, ms", "memory there, MiB"});
    for (const std::string& solver : best.solvers()) {
      std::vector<double> sizes, seconds;
      const json* largest = nullptr;
      for (const double size : best.places()) {
        const json* p = best.find(solver, size);
        if (!p) continue;
        sizes.push_back(size);
        seconds.push_back(median_seconds(*p) * p->at("step").get<double>());
        largest = p;
      }
      if (sizes.size() < 2) continue;
      const Slope slope = log_log_slope(sizes, seconds);
      std::string exponent = number_text(slope.value, 3);
      if (std::isfinite(slope.half_width))
        exponent +=
            " (" + number_text(slope.low(), 3) + " to " + number_text(slope.high(), 3) + ")";
      print_row(out, {quoted(solver),
                      number_text(sizes.front(), 7) + " to " + number_text(sizes.back(), 7),
                      exponent, plain(1e3 * seconds.back(), 3),
                      plain(number(largest->at("peak_rss_bytes")) / (1 << 20), 3)});
    }
    out << '\n';
  }
}

void print_hard_cases(std::ostream& out, const NamedResult& result) {
  if (!is_stability(result.document)) return;
  constexpr std::array outcomes{"survived", "survived_smaller", "refused", "diverged",
                                "wrong",    "timeout",          "crashed"};
  std::vector<std::string> solvers;
  std::map<std::string, std::map<std::string, int>> count;
  int unexpected = 0;
  for (const json& cell : result.document.at("matrix")) {
    const std::string solver = cell.at("solver");
    if (!count.contains(solver)) solvers.push_back(solver);
    ++count[solver][cell.at("outcome")];
    unexpected += cell.at("as_expected").get<bool>() ? 0 : 1;
  }
  out << "## Hard cases (`" << result.name << "`)\n\n"
      << "How each solver ends in small scenes that are known to break solvers; what the outcomes "
         "mean is in [measuring.md](measuring.md#hard-cases). Not as expected: "
      << unexpected << " of " << result.document.at("matrix").size() << ".\n\n";
  std::vector<std::string> row{"solver"};
  for (const char* outcome : outcomes) row.push_back(std::string(outcome) + ", cases");
  print_head(out, row);
  for (const std::string& solver : solvers) {
    row = {quoted(solver)};
    for (const char* outcome : outcomes) row.push_back(std::to_string(count[solver][outcome]));
    print_row(out, row);
  }
  out << '\n';
}

void print_sources(std::ostream& out, const std::vector<NamedResult>& results) {
  print_head(out, {"file", "date", "processor", "commit"});
  for (const NamedResult& result : results) {
    const json& context = result.document.at("context");
    print_row(out, {quoted(result.name), context.at("date"), context.at("cpu_model"),
                    context.at("build").at("git")});
  }
}

}  // namespace

void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& growth) try {
  std::vector<json> documents;
  for (const NamedResult& result : results) documents.push_back(result.document);
  out << "## The paper's claims\n\n";
  print_claims_markdown(out, judge_claims(documents));
  out << "\n## Time over permitted strain\n\n";
  for (const NamedResult& result : results) print_best(out, result, "strain");
  out << "## Time over resolution\n\n";
  for (const NamedResult& result : results) print_best(out, result, "resolution");
  out << "## Time to reach an error\n\n";
  for (const NamedResult& result : results) print_time_to_error(out, result);
  out << "## Growth\n\nThe time of a step grows as the number of vertices to this exponent.\n\n";
  for (const auto* files : {&results, &growth}) {
    for (const NamedResult& result : *files) print_growth(out, result);
  }
  for (const NamedResult& result : results) print_hard_cases(out, result);
  out << "## Where these numbers come from\n\n";
  std::vector<NamedResult> all = results;
  all.insert(all.end(), growth.begin(), growth.end());
  print_sources(out, all);
} catch (const json::exception& error) {
  throw UsageError(std::string("a result file lacks something: ") + error.what());
}

}  // namespace harness
