#include "harness/claims/robustness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "harness/analysis/paper_methods.h"
#include "harness/base/text.h"

namespace harness::claims {

using nlohmann::json;

namespace {

// Calibrations at one step.
struct Stiffness {
  std::vector<double> factors;  // EA x limit / weight
  std::vector<std::string> ids;

  Ratio spread() const {
    const auto [low, high] = std::minmax_element(factors.begin(), factors.end());
    const double spread = *high / *low;
    // Each meets its limit to 15 %: the strain that counts is as far below the limit.
    return {spread, spread * calibration_tolerance, spread / calibration_tolerance};
  }

  static constexpr double calibration_tolerance = 0.85;
};

bool calibrated(const Point& p) {
  return p.is("scene", "drape") && p.contestant() == implicit_springs.name && p.ok() &&
         std::isfinite(p.option("stiffness")) &&
         p.number("max_strain") >=
             0.999 * Stiffness::calibration_tolerance * p.number("strain_limit");
}

// Whether some run of a hard case has strains of its first and last second.
bool ten_seconds(const Points& points, const std::string& hard_case) {
  return std::any_of(points.matrix().begin(), points.matrix().end(), [&](const json* cell) {
    return cell->at("case") == hard_case && cell->value("strain_last_second", json()).is_number();
  });
}

}  // namespace

void springs_stiffness(const Points& points, ClaimVerdict& c) {
  c.rule =
      "a stiffness set a priori would be EA = c x weight / limit with one c for all limits and "
      "sizes; at the step with most calibrations that met their limit (time-outs say nothing), "
      "three or more: reproduced if the largest c is more than twice the smallest, not reproduced "
      "if less; undecided if the calibrations' own tolerance (15 %) leaves it open";
  std::map<double, Stiffness> by_step;
  for (const Point& p : points.where(calibrated)) {
    Stiffness& here = by_step[p.number("step")];
    here.factors.push_back(p.option("stiffness") * p.number("strain_limit") /
                           (p.scene_parameter("mass") * p.scene_parameter("gravity")));
    here.ids.push_back(p.id());
  }
  const auto most = std::max_element(by_step.begin(), by_step.end(), [](auto& a, auto& b) {
    return a.second.factors.size() < b.second.factors.size();
  });
  if (most == by_step.end() || most->second.factors.size() < 3) return;
  const Stiffness& found = most->second;
  const auto [low, high] = std::minmax_element(found.factors.begin(), found.factors.end());
  c.measured = "at a step of " + step_text(most->first) + " s EA x limit / weight from " +
               text(*low, 2) + " to " + text(*high, 2) + " over " +
               std::to_string(found.factors.size()) + " calibrations, a factor of " +
               text(found.spread());
  c.points = found.ids;
  c.verdict = verdict_of(above(found.spread(), 2));
}

void failure_configurations(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if SHAKE refuses exactly Q1, Q2 and Q4 at the fixed step and with smaller ones, "
      "and fast projection and ICD survive them, and Q3 at least with smaller steps; changed if "
      "SHAKE gets through some of them, or through with smaller steps; not reproduced otherwise";
  bool shake_always = true, shake_sometimes = false, others = true;
  std::string told;
  for (const char* q : {"Q1", "Q2", "Q3", "Q4"}) {
    for (const char* solver : {shake.name, fast_projection.name, icd.name}) {
      const json* cell = points.cell(q, solver);
      if (!cell) return;
      const std::string fixed = cell->at("at_fixed_step"), outcome = cell->at("outcome");
      c.points.push_back(std::string(q) + "/" + solver);
      if (solver == shake.name) {
        told += std::string(told.empty() ? "" : ", ") + q + " " +
                (fixed == outcome
                     ? fixed
                     : fixed + (outcome == "survived_smaller" ? " (but survived with smaller steps)"
                                                              : ""));
        if (q == std::string("Q3")) continue;
        shake_always = shake_always && outcome == "refused";
        shake_sometimes = shake_sometimes || fixed == "refused";
      } else {
        others = others &&
                 (fixed == "survived" || (q == std::string("Q3") && outcome == "survived_smaller"));
      }
    }
  }
  c.measured = "SHAKE: " + told + "; fast projection and ICD: " +
               (others ? "all four survived, Q3 at least with smaller steps" : "not all survived");
  c.verdict = !others || !shake_sometimes ? not_reproduced : shake_always ? reproduced : changed;
}

void no_drift(const Points& points, ClaimVerdict& c) {
  c.rule =
      "hard cases that last ten simulated seconds, with and without vertices displaced before "
      "every step; in all runs of fast projection's and ICD's families that survive, with smaller "
      "steps if need be, the largest strain of the last second is at most 1.5 times that of the "
      "first: reproduced; more than 3 times in one: not reproduced; between: undecided; changed "
      "if no error accumulates, but a run is refused or fails otherwise";
  std::vector<Answer> answers;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::string failed;
  for (const json* cell : points.matrix()) {
    const std::string solver = cell->at("solver"), hard_case = cell->at("case");
    if (!points.same_family(solver, icd.name) && !points.same_family(solver, fast_projection.name))
      continue;
    const json first = cell->value("strain_first_second", json());
    const json last = cell->value("strain_last_second", json());
    const std::string outcome = cell->at("outcome");
    if (outcome.starts_with("survived") && first.is_number() && last.is_number()) {
      // Below 1e-9 strain is rounding, which may do as it likes.
      const double growth =
          std::max(last.get<double>(), 1e-9) / std::max(first.get<double>(), 1e-9);
      answers.push_back(growth <= 1.5 ? Answer::yes : growth <= 3 ? Answer::open : Answer::no);
      least = std::min(least, growth);
      most = std::max(most, growth);
    } else if (!outcome.starts_with("survived") && ten_seconds(points, hard_case)) {
      failed += "; " + solver + " ends as " + outcome + " in " + hard_case;
    } else {
      continue;
    }
    c.points.push_back(hard_case + "/" + solver);
  }
  if (answers.empty()) {
    c.points.clear();
    return;
  }
  c.measured = "strain of the last second over that of the first from " + text(least) + " to " +
               text(most) + " in " + std::to_string(answers.size()) + " runs" + failed;
  const Answer all = all_of(answers);
  c.verdict = all == Answer::yes && !failed.empty() ? changed : verdict_of(all);
}

void degrees_of_freedom_left(const Points& points, ClaimVerdict& c) {
  c.rule =
      "degrees of freedom per vertex (3 less the rank of J over the vertices, SuiteSparseQR): "
      "reproduced if with quads within 25 % of 1 on the largest mesh, with triangles below a fifth "
      "of that; not reproduced otherwise";
  double quads = std::nan(""), triangles = std::nan("");
  int largest = 0;
  for (const json* mesh : points.freedom()) {
    const int n = mesh->at("vertices");
    if (n < largest) continue;
    largest = n;
    const double each = mesh->at("degrees_of_freedom").get<double>() / n;
    (mesh->at("mesh") == "quads" ? quads : triangles) = each;
  }
  if (std::isnan(quads) || std::isnan(triangles)) return;
  c.measured = std::to_string(largest) + " vertices: " + text(quads) + " a vertex with quads, " +
               text(triangles) + " with triangles";
  c.verdict = std::abs(quads - 1) < 0.25 && triangles < 0.2 * quads ? reproduced : not_reproduced;
}

}  // namespace harness::claims
