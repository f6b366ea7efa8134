// C4, C9, C10 and C14: what works at all.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "harness/base/text.h"
#include "harness/claims/claims.h"

namespace harness::claims {

using nlohmann::json;

namespace {

// What a calibrated point says of the tension: EA x strain over the weight that hangs on a strand,
// which is all of a chain's, and of a square cloth what falls to one of its rows and columns.
double tension_over_weight(const Point& p) {
  const double strands = p.scene() == "chain" ? 1 : 2 * std::sqrt(p.vertices());
  return p.stiffness() * p.measures().max_strain * strands /
         (p.scene_parameter("mass") * p.scene_parameter("gravity"));
}

constexpr double calibration_tolerance = 0.85;  // of the limit, the least strain that meets it

bool calibrated(const Point& p) {
  return p.contestant() == implicit_springs.name && p.ok() && p.sweep() == "strain" &&
         std::isfinite(p.stiffness()) && std::isfinite(tension_over_weight(p)) &&
         p.measures().max_strain >= 0.999 * calibration_tolerance * p.strain_limit();
}

}  // namespace

Verdict springs_stiffness(const Points& points) {
  Verdict found;
  using Places = std::map<std::pair<std::string, double>, std::vector<double>>;
  std::map<double, Places> by_step;  // then by scene and vertices
  for (const Point& p : points.all) {
    if (calibrated(p))
      by_step[p.step()][{p.scene(), p.vertices()}].push_back(tension_over_weight(p));
  }
  if (by_step.empty()) return {};
  const auto [step, places] = *std::ranges::max_element(by_step, {}, [](const auto& at) {
    std::size_t all = 0;
    for (const auto& [place, here] : at.second) all += here.size();
    return all;
  });
  for (const Point& p : points.all) {
    if (calibrated(p) && p.step() == step) found.points.push_back(p.id());
  }
  if (found.points.size() < 3) return {};
  // Where most was calibrated at one step: what it says is to be true elsewhere.
  const auto [known, there] =
      *std::ranges::max_element(places, {}, [](const auto& at) { return at.second.size(); });
  double log_sum = 0;
  for (const double tension : there) log_sum += std::log(tension);
  const double expected = std::exp(log_sum / static_cast<double>(there.size()));
  double factor = 1;
  std::string details;
  for (const auto& [place, here] : places) {
    const auto [least, largest] = std::ranges::minmax(here);
    const double low = least / expected, high = largest / expected;
    factor = std::max({factor, high, 1 / low});
    append(details, place.first + " of " + text(place.second, 6) + " " + text(low, 2) +
                        (high > low ? " to " + text(high, 2) : ""));
  }
  found.measured = "at a step of " + step_text(step) + " s, calibrated on " + known.first + " of " +
                   text(known.second, 6) + " vertices: the strain over its limit is " + details +
                   "; off by a factor of " + text(factor, 2) + " at most";
  found.verdict = verdict_of(
      above(Ratio{factor, factor * calibration_tolerance, factor / calibration_tolerance}, 2));
  return found;
}

Verdict failure_configurations(const Points& points) {
  Verdict found;
  bool shake_always = true, shake_sometimes = false, others = true;
  std::string details;
  for (const std::string q : {"Q1", "Q2", "Q3", "Q4"}) {
    for (const std::string solver : {shake.name, fast_projection.name, icd.name}) {
      const auto cell = std::ranges::find_if(points.matrix, [&](const json* c) {
        return c->at("case") == q && c->at("solver") == solver;
      });
      if (cell == points.matrix.end()) return {};
      const std::string fixed = (*cell)->at("at_fixed_step"), outcome = (*cell)->at("outcome");
      const bool smaller = outcome == "survived_smaller";
      found.points.push_back(q + "/" + solver);
      if (solver != shake.name) {
        others = others && (fixed == "survived" || (q == "Q3" && smaller));
        continue;
      }
      append(details, q + " " + fixed + (smaller ? " (but survived with smaller steps)" : ""));
      shake_always = shake_always && (q == "Q3" || outcome == "refused");
      shake_sometimes = shake_sometimes || (q != "Q3" && fixed == "refused");
    }
  }
  found.measured =
      "SHAKE: " + details + "; fast projection and ICD: " +
      (others ? "all four survived, Q3 at least with smaller steps" : "not all survived");
  found.verdict = !others || !shake_sometimes ? not_reproduced
                  : shake_always              ? reproduced
                                              : changed;
  return found;
}

Verdict no_drift(const Points& points) {
  Verdict found;
  std::vector<Answer> answers;
  std::vector<double> growths;
  std::string failed;
  const auto last_second = [](const json& cell) {
    return cell.value("strain_last_second", json());
  };
  for (const json* cell : points.matrix) {
    const std::string solver = cell->at("solver"), hard_case = cell->at("case"),
                      outcome = cell->at("outcome"), family = points.roles.of(solver).family;
    if (family != points.roles.of(icd.name).family &&
        family != points.roles.of(fast_projection.name).family)
      continue;
    const json first = cell->value("strain_first_second", json()), last = last_second(*cell);
    const bool survived = outcome.starts_with("survived");
    if (survived && first.is_number() && last.is_number()) {
      // Below 1e-9 strain is rounding, which may do as it likes.
      const double growth =
          std::max(last.get<double>(), 1e-9) / std::max(first.get<double>(), 1e-9);
      growths.push_back(growth);
      answers.push_back(growth <= 1.5 ? Answer::yes : growth <= 3 ? Answer::open : Answer::no);
    } else if (!survived && std::ranges::any_of(points.matrix, [&](const json* other) {
                 return other->at("case") == hard_case && last_second(*other).is_number();
               })) {  // the case lasts long enough
      failed += "; " + solver + " ends as " + outcome + " in " + hard_case;
    } else {
      continue;
    }
    found.points.push_back(hard_case + "/" + solver);
  }
  if (answers.empty()) return {};
  const auto [least, most] = std::ranges::minmax(growths);
  found.measured = "strain of the last second over that of the first from " + text(least) + " to " +
                   text(most) + " in " + std::to_string(answers.size()) + " runs" + failed;
  const Answer all = all_of(answers);
  found.verdict = all == Answer::yes && !failed.empty() ? changed : verdict_of(all);
  return found;
}

Verdict degrees_of_freedom_left(const Points& points) {
  std::map<std::string, double> left;  // a vertex, by mesh
  int largest = 0;
  for (const json* mesh : points.freedom) {
    const int n = mesh->at("vertices");
    if (n < largest) continue;
    largest = n;
    left[mesh->at("mesh")] = mesh->at("degrees_of_freedom").get<double>() / n;
  }
  if (!left.contains("quads") || !left.contains("triangles")) return {};
  const double quads = left["quads"], triangles = left["triangles"];
  std::string measured = std::to_string(largest) + " vertices: " + text(quads) +
                         " a vertex with quads, " + text(triangles) + " with triangles";
  if (left.contains("midpoints"))
    measured += ", " + text(left["midpoints"]) + " with midpoints of triangles' edges";
  return {verdict_of(yes_if(std::abs(quads - 1) < 0.25 && triangles < 0.2 * quads)), measured, {}};
}

}  // namespace harness::claims
