#include "harness/claims/cost.h"

#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace harness::claims {

void chain_time_over_strain(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if the log-log slope of time over strain limit is steeper (more negative) for "
      "implicit springs, 95 % intervals apart; changed if steeper with intervals that overlap";
  const auto springs = points.best("chain", "strain", "implicit_springs");
  const auto fast = points.best("chain", "strain", "fast_projection");
  if (springs.size() < 3 || fast.size() < 3) return;
  const Slope s = slope_of(springs), f = slope_of(fast);
  c.measured = "slopes: implicit springs " + text(s) + ", fast projection " + text(f) + "; ratio " +
               text(springs.rbegin()->second.seconds() / fast.rbegin()->second.seconds()) + " at " +
               percent(springs.rbegin()->first) + ", " +
               text(springs.begin()->second.seconds() / fast.begin()->second.seconds()) + " at " +
               percent(springs.begin()->first);
  c.verdict = below(s, f) ? reproduced : s.value < f.value ? changed : not_reproduced;
  cite(c, springs);
  cite(c, fast);
}

void chain_time_over_resolution(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if the exponent of time over vertices is smaller for fast projection, 95 % "
      "intervals apart; changed if smaller with intervals that overlap";
  const auto springs = points.best("chain", "resolution", "implicit_springs");
  const auto fast = points.best("chain", "resolution", "fast_projection");
  if (springs.size() < 3 || fast.size() < 3) return;
  const Slope s = slope_of(springs), f = slope_of(fast);
  c.measured = "exponents: implicit springs " + text(s) + ", fast projection " + text(f) +
               "; ratio " +
               text(springs.begin()->second.seconds() / fast.begin()->second.seconds()) + " at " +
               text(springs.begin()->first) + " vertices, " +
               text(springs.rbegin()->second.seconds() / fast.rbegin()->second.seconds()) + " at " +
               text(springs.rbegin()->first, 6);
  c.verdict = below(f, s) ? reproduced : f.value < s.value ? changed : not_reproduced;
  cite(c, springs);
  cite(c, fast);
}

void chain_speed(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if implicit springs take 12.5 to 50 times as long; changed if above 1.1 but "
      "outside of that; not reproduced otherwise";
  const auto springs = at(points.best("chain", "strain", "implicit_springs"), 0.01);
  const auto fast = at(points.best("chain", "strain", "fast_projection"), 0.01);
  if (!springs || !fast) return;
  const double ratio = springs->seconds() / fast->seconds();
  const auto apart = [](const Point& p) {
    const double iterations = p.work("iterations");
    return text(p.steps(), 5) + " steps of " + text(iterations / p.work("steps"), 2) +
           " iterations of " + text(1e6 * p.seconds() * p.number("duration") / iterations, 3) +
           " us";
  };
  c.measured = "ratio " + text(ratio) + ": implicit springs " + apart(*springs) +
               ", fast projection " + apart(*fast) + "; calibration of the stiffness (" +
               text(springs->work("calibration_runs")) + " runs) is not charged";
  c.verdict = ratio >= 12.5 && ratio <= 50 ? reproduced : ratio > 1.1 ? changed : not_reproduced;
  c.points = {springs->id(), fast->id()};
}

void drape_time_over_strain(const Points& points, ClaimVerdict& c) {
  c.rule =
      "(a) slopes of time over limit: SHAKE, ICD and fast projection each flatter than Jacobi "
      "and Gauss-Seidel, 95 % intervals apart; (b) fast projection fastest of the three at every "
      "limit that two of them reach; both: reproduced, one: changed, none: not reproduced";
  std::map<std::string, Curve> curves;
  for (const char* solver : {"shake", "icd", "fast_projection", "jacobi", "gauss_seidel"}) {
    curves.emplace(solver, points.best("drape", "strain", solver));
    cite(c, curves.at(solver));
  }
  if (curves.at("fast_projection").size() < 3 || curves.at("jacobi").size() < 3 ||
      curves.at("gauss_seidel").size() < 3 ||
      curves.at("shake").size() + curves.at("icd").size() < 3)
    return;
  bool flatter = true, fastest = true;
  std::string slopes;
  for (const auto& [solver, curve] : curves) {
    slopes += (slopes.empty() ? "" : ", ") + solver + " " + text(slope_of(curve));
    if (solver == "jacobi" || solver == "gauss_seidel" || curve.size() < 3) continue;
    for (const char* limiting : {"jacobi", "gauss_seidel"})
      flatter = flatter && below(slope_of(curves.at(limiting)), slope_of(curve));
    for (const auto& [limit, point] : curve) {
      const auto fast = at(curves.at("fast_projection"), limit);
      fastest = fastest && fast && fast->seconds() <= point.seconds();
    }
  }
  // Where fast projection overtakes the faster of the strain-limiting methods.
  std::string overtakes = "nowhere";
  for (auto fast = curves.at("fast_projection").rbegin();
       fast != curves.at("fast_projection").rend(); ++fast) {
    bool ahead = true;
    for (const char* limiting : {"jacobi", "gauss_seidel"}) {
      const auto other = at(curves.at(limiting), fast->first);
      ahead = ahead && (!other || fast->second.seconds() < other->seconds());
    }
    if (ahead) {
      overtakes = "from " + percent(fast->first) + " down";
      break;
    }
  }
  c.measured = "slopes: " + slopes + "; fast projection " +
               (fastest ? "is the fastest of the three everywhere"
                        : "is not always the fastest of the three") +
               ", ahead of strain limiting " + overtakes;
  c.verdict = flatter && fastest ? reproduced : flatter || fastest ? changed : not_reproduced;
}

void drape_time_over_resolution(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if fast projection is the fastest of the paper's methods at every size; changed "
      "if at the largest only; not reproduced otherwise";
  const auto fast = points.best("drape", "resolution", "fast_projection");
  if (fast.size() < 2) return;
  std::string won, lost;
  bool at_largest = false;
  for (const auto& [vertices, point] : fast) {
    std::string rival;
    double best = std::numeric_limits<double>::infinity();
    for (const char* solver : {"implicit_springs", "jacobi", "gauss_seidel", "shake", "icd"}) {
      const auto other = at(points.best("drape", "resolution", solver), vertices);
      if (other && other->seconds() < best) {
        best = other->seconds();
        rival = solver;
      }
    }
    at_largest = point.seconds() <= best;
    const std::string cell = text(vertices, 6) + " (" + rival + " takes " +
                             text(best / point.seconds(), 2) + " of its time)";
    std::string& list = at_largest ? won : lost;
    list += (list.empty() ? "" : ", ") + cell;
  }
  cite(c, fast);
  c.measured = "fastest at " + (won.empty() ? "no size" : won) +
               (lost.empty() ? "" : "; not fastest at " + lost);
  c.verdict = lost.empty() ? reproduced : at_largest ? changed : not_reproduced;
}

void matrix_sizes(const Points& points, ClaimVerdict& c) {
  c.rule =
      "at each drape size that both ran, ICD with its own matrix factored (projected conjugate "
      "gradients factor fast projection's): reproduced if ICD's factor has more nonzeros; the "
      "matrices are 2 n and 5 n wide by construction";
  std::map<double, std::pair<double, double>> nonzeros;  // vertices -> fast projection, ICD
  for (const Point& p : points.where([](const Point& q) {
         return q.is("scene", "drape") && q.ok() && q.work("factor_nonzeros") > 0 &&
                !q.solves_by("projected_cg") && !q.solves_by("hybrid");
       })) {
    auto& pair = nonzeros[p.number("vertices")];
    double* place = p.is("solver", "fast_projection") ? &pair.first
                    : p.is("solver", "icd")           ? &pair.second
                                                      : nullptr;
    if (!place) continue;
    if (*place == 0) c.points.push_back(p.id());
    *place = p.work("factor_nonzeros");
  }
  bool all = true;
  for (const auto& [vertices, pair] : nonzeros) {
    if (pair.first == 0 || pair.second == 0) continue;
    c.measured +=
        (c.measured.empty() ? "nonzeros of ICD's factor over fast projection's: " : ", ") +
        text(pair.second / pair.first, 2) + " at " + text(vertices, 6) + " vertices";
    all = all && pair.second > pair.first;
  }
  if (!c.measured.empty()) c.verdict = all ? reproduced : not_reproduced;
}

void shake_small_steps(const Points& points, ClaimVerdict& c) {
  c.rule =
      "best points of the strain sweeps: reproduced if at every limit SHAKE's step is smaller than "
      "ICD's and each of its steps cheaper; changed if at most limits";
  int both = 0, all = 0;
  std::string example;
  for (const char* scene : {"chain", "drape"}) {
    const auto icd = points.best(scene, "strain", "icd");
    for (const auto& [limit, p] : points.best(scene, "strain", "shake")) {
      const auto other = at(icd, limit);
      if (!other) continue;
      const double cost = p.seconds() * p.number("step");
      const double icd_cost = other->seconds() * other->number("step");
      ++all;
      if (p.number("step") < other->number("step") && cost < icd_cost) ++both;
      c.points.push_back(p.id());
      c.points.push_back(other->id());
      if (std::abs(limit - 0.01) < 1e-9)
        example += std::string("; ") + scene + " at 1 %: SHAKE 1/" + text(1 / p.number("step"), 6) +
                   " s, " + text(1e3 * cost) + " ms a step, ICD 1/" +
                   text(1 / other->number("step"), 6) + " s, " + text(1e3 * icd_cost) + " ms";
    }
  }
  if (all == 0) return;
  c.measured = "so at " + std::to_string(both) + " of " + std::to_string(all) + " limits" + example;
  c.verdict = both == all ? reproduced : 2 * both > all ? changed : not_reproduced;
}

}  // namespace harness::claims
