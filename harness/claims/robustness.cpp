// C4, C9, C10 and C14: what works at all.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/claims/judging.h"

namespace harness::claims {

using nlohmann::json;

namespace {

// What a calibrated point says of the tension: EA x strain over the weight that hangs on a strand,
// which is all of a chain's, and of a square cloth what falls to one of its rows and columns.
double tension_over_weight(const Point& p) {
  const double strands = p.is("scene", "chain") ? 1 : 2 * std::sqrt(p.number("vertices"));
  return p.option("stiffness") * p.number("max_strain") * strands /
         (p.scene_parameter("mass") * p.scene_parameter("gravity"));
}

constexpr double calibration_tolerance = 0.85;  // of the limit, the least strain that meets it

bool calibrated(const Point& p) {
  return p.contestant() == implicit_springs.name && p.ok() && p.is("sweep", "strain") &&
         std::isfinite(p.option("stiffness")) && std::isfinite(tension_over_weight(p)) &&
         p.number("max_strain") >= 0.999 * calibration_tolerance * p.number("strain_limit");
}

// By scene, then vertices.
using Places = std::map<std::pair<std::string, double>, std::vector<Point>>;

// Where most was calibrated at one step: what it says is to be true elsewhere.
Places::const_iterator calibration_place(const Places& places) {
  return std::max_element(places.begin(), places.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
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
      "a stiffness set a priori would be EA = c x weight a strand / limit, with the c that "
      "calibrations found at one scene and size (where most of them met their limit at one step; "
      "the "
      "geometric mean over limits). At other scenes, sizes and limits of strain sweeps, at the "
      "same "
      "step, the strain is then off its limit by the ratio of the c's: reproduced if somewhere by "
      "more than a factor of 2, not reproduced if nowhere; undecided if what the law is good for "
      "(15 %) leaves it open";
  std::map<double, Places> by_step;
  std::map<double, std::size_t> counts;
  for (const Point& p : points.where(calibrated)) {
    by_step[p.number("step")][{p.text("scene"), p.number("vertices")}].push_back(p);
    ++counts[p.number("step")];
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  if (most == counts.end()) return;
  const Places& places = by_step.at(most->first);
  const auto known = calibration_place(places);
  double log_sum = 0;
  for (const Point& p : known->second) log_sum += std::log(tension_over_weight(p));
  const double c_known = std::exp(log_sum / static_cast<double>(known->second.size()));
  double worst = 0;  // logarithm of the factor
  std::string told;
  for (const auto& [place, here] : places) {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const Point& p : here) {
      const double off = tension_over_weight(p) / c_known;
      low = std::min(low, off);
      high = std::max(high, off);
      worst = std::max(worst, std::abs(std::log(off)));
      c.points.push_back(p.id());
    }
    told += (told.empty() ? "" : ", ") + place.first + " of " + text(place.second, 6) + " " +
            text(low, 2) + (high > low ? " to " + text(high, 2) : "");
  }
  if (c.points.size() < 3) return;
  const double factor = std::exp(worst);
  c.measured = "at a step of " + step_text(most->first) + " s, calibrated on " +
               known->first.first + " of " + text(known->first.second, 6) +
               " vertices: the strain over its limit is " + told + "; off by a factor of " +
               text(factor, 2) + " at most";
  c.verdict = verdict_of(
      above(Ratio{factor, factor * calibration_tolerance, factor / calibration_tolerance}, 2));
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
  std::map<std::string, double> left;  // a vertex, by mesh
  int largest = 0;
  for (const json* mesh : points.freedom()) {
    const int n = mesh->at("vertices");
    if (n < largest) continue;
    largest = n;
    const double each = mesh->at("degrees_of_freedom").get<double>() / n;
    left[mesh->at("mesh")] = each;
  }
  if (!left.contains("quads") || !left.contains("triangles")) return;
  const double quads = left["quads"], triangles = left["triangles"];
  c.measured = std::to_string(largest) + " vertices: " + text(quads) + " a vertex with quads, " +
               text(triangles) + " with triangles";
  if (left.contains("midpoints"))
    c.measured += ", " + text(left["midpoints"]) + " with midpoints of triangles' edges";
  c.verdict = std::abs(quads - 1) < 0.25 && triangles < 0.2 * quads ? reproduced : not_reproduced;
}

}  // namespace harness::claims
