#include "harness/claims/claims.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/fit.h"
#include "harness/base/text.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr const char* reproduced = "reproduced";
constexpr const char* not_reproduced = "not reproduced";
constexpr const char* changed = "changed";
constexpr const char* not_measured = "not yet measured";

std::string text(double value, int digits = 3) { return number_text(value, digits); }

std::string percent(double fraction) { return text(100 * fraction) + " %"; }

std::string text(const Slope& slope) {
  return text(slope.value, 2) +
         (std::isfinite(slope.half_width) ? " ± " + text(slope.half_width, 1) : "");
}

bool below(const Slope& a, const Slope& b) { return a.high() < b.low(); }

// A point of a result file, as far as claims need it.
class Point {
 public:
  explicit Point(const json& document) : p_(&document) {}

  std::string id() const { return p_->at("id"); }
  std::string text(const char* key) const { return p_->at(key); }
  bool is(const char* key, const std::string& value) const { return p_->at(key) == value; }
  bool flag(const char* key) const { return p_->value(key, false); }
  bool ok() const { return is("status", "ok"); }
  double number(const char* key) const { return figure(*p_, key); }
  double work(const char* key) const { return figure(p_->at("work"), key); }
  double error(const char* key) const { return figure(p_->at("error"), key); }
  bool solves_by(const std::string& linear_solver) const {
    return p_->at("options").value("linear_solver", "") == linear_solver;
  }
  double option(const char* key) const { return figure(p_->at("options"), key); }
  double scene_parameter(const char* key) const { return figure(p_->at("scene_parameters"), key); }
  double seconds() const {
    const json& s = p_->at("seconds_per_simulated_second");
    return s.is_null() ? std::nan("") : s.at("median").get<double>();
  }
  double steps() const { return number("duration") / number("step"); }

 private:
  static double figure(const json& object, const char* key) {
    const auto place = object.find(key);
    return place == object.end() || !place->is_number() ? std::nan("") : place->get<double>();
  }
  const json* p_;
};

using Filter = std::function<bool(const Point&)>;

class Points {
 public:
  explicit Points(const std::vector<json>& results) {
    std::set<std::pair<std::string, std::string>> seen;  // id and sweep
    for (const json& result : results) {
      if (result.value("schema", "") == "inextensible-stability/1") {
        for (const json& cell : result.at("matrix")) matrix_.push_back(&cell);
        for (const json& mesh : result.at("degrees_of_freedom")) freedom_.push_back(&mesh);
        continue;
      }
      std::set<std::pair<std::string, std::string>> here;
      for (const json& p : result.at("points")) {
        const std::pair key(p.at("id").get<std::string>(), p.at("sweep").get<std::string>());
        if (seen.contains(key) || p.value("adaptive", false)) continue;
        here.insert(key);
        all_.emplace_back(p);
      }
      seen.merge(here);
    }
    for (const Point& p : all_) {
      if (!p.is("sweep", "strain")) continue;
      double& largest = largest_[p.text("scene")];
      largest = std::max(largest, p.number("vertices"));
    }
  }

  std::vector<Point> where(const Filter& wanted) const {
    std::vector<Point> chosen;
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(chosen), wanted);
    return chosen;
  }

  // The cell of a stability sweep; null if there is none.
  const json* cell(const std::string& hard_case, const std::string& solver) const {
    const auto place = std::find_if(matrix_.begin(), matrix_.end(), [&](const json* c) {
      return c->at("case") == hard_case && c->at("solver") == solver;
    });
    return place == matrix_.end() ? nullptr : *place;
  }
  const std::vector<const json*>& matrix() const { return matrix_; }
  const std::vector<const json*>& freedom() const { return freedom_; }

  // Best points of one solver over the axis of a sweep: axis value -> point.
  std::map<double, Point> best(const std::string& scene, const std::string& sweep,
                               const std::string& solver) const {
    const char* axis = sweep == "strain" ? "strain_limit" : "vertices";
    std::map<double, Point> curve;
    for (const Point& p : where([&](const Point& q) {
           return of(q, scene, sweep) && q.is("solver", solver) && q.flag("best") && q.ok();
         }))
      curve.try_emplace(p.number(axis), p);
    return curve;
  }

  // How many places on the axis were tried, failures too.
  std::size_t places(const std::string& scene, const std::string& sweep,
                     const std::string& solver) const {
    const char* axis = sweep == "strain" ? "strain_limit" : "vertices";
    std::set<double> seen;
    for (const Point& p : all_) {
      if (of(p, scene, sweep) && p.is("solver", solver)) seen.insert(p.number(axis));
    }
    return seen.size();
  }

 private:
  // Strain sweeps of several sizes may come together: the largest counts.
  bool of(const Point& point, const std::string& scene, const std::string& sweep) const {
    if (!point.is("scene", scene) || !point.is("sweep", sweep)) return false;
    return sweep != "strain" || point.number("vertices") == largest_.at(scene);
  }

  std::vector<Point> all_;
  std::map<std::string, double> largest_;  // vertices in a scene's strain sweeps
  std::vector<const json*> matrix_, freedom_;
};

using Curve = std::map<double, Point>;

Slope slope_of(const Curve& curve) {
  std::vector<double> x, y;
  for (const auto& [at, point] : curve) {
    x.push_back(at);
    y.push_back(point.seconds());
  }
  return log_log_slope(x, y);
}

void cite(ClaimVerdict& claim, const Curve& curve) {
  for (const auto& [at, point] : curve) claim.points.push_back(point.id());
}

std::optional<Point> at(const Curve& curve, double x) {
  for (const auto& [key, point] : curve) {
    if (std::abs(key / x - 1) < 1e-9) return point;
  }
  return {};
}

void c1(const Points& points, ClaimVerdict& c) {
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

void c2(const Points& points, ClaimVerdict& c) {
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

void c3(const Points& points, ClaimVerdict& c) {
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

void c4(const Points& points, ClaimVerdict& c) {
  c.rule =
      "a stiffness set a priori would be EA = c x weight / limit with one c; reproduced if the c "
      "that calibration found differ by more than 2 over steps and limits, or none was found";
  const auto tried = points.where([](const Point& p) {
    return p.is("scene", "drape") && p.is("solver", "implicit_springs") &&
           !p.is("status", "skipped");
  });
  if (tried.size() < 3) return;
  std::vector<double> factors;
  std::size_t none = 0;
  for (const Point& p : tried) {
    const double stiffness = p.option("stiffness");
    if (std::isfinite(stiffness)) {
      factors.push_back(stiffness * p.number("strain_limit") /
                        (p.scene_parameter("mass") * p.scene_parameter("gravity")));
    } else {
      ++none;
    }
    c.points.push_back(p.id());
  }
  if (factors.empty() && none < tried.size()) return;
  std::ostringstream out;
  double spread = std::numeric_limits<double>::infinity();
  if (!factors.empty()) {
    const auto [low, high] = std::minmax_element(factors.begin(), factors.end());
    spread = *high / *low;
    out << "EA x limit / weight from " << text(*low, 2) << " to " << text(*high, 2) << ", ";
  }
  out << none << " of " << tried.size() << " calibrations found no stiffness";
  c.measured = out.str();
  c.verdict = spread > 2 || 2 * none > tried.size() ? reproduced : not_reproduced;
}

void c5(const Points& points, ClaimVerdict& c) {
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

void c6(const Points& points, ClaimVerdict& c) {
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

void c7(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if the residual after the first iteration falls at least with h^2 in every "
      "scene (slope over the four finest steps at the tightest limit, 95 % interval above 2 or "
      "containing it) and the last iteration's mean residual is at most 1.1 times the first's";
  bool order = true, later = true, any = false;
  for (const char* scene : {"chain", "drape"}) {
    double tightest = 1e300;
    const auto chosen = points.where([&](const Point& p) {
      return p.is("scene", scene) && p.is("sweep", "step") && p.is("solver", "fast_projection") &&
             p.ok() && std::isfinite(p.error("residual_first"));
    });
    for (const Point& p : chosen) tightest = std::min(tightest, p.number("strain_limit"));
    std::map<double, Point> by_step;
    for (const Point& p : chosen) {
      if (p.number("strain_limit") == tightest) by_step.try_emplace(p.number("step"), p);
    }
    if (by_step.size() < 4) continue;
    std::vector<double> h, first, last;
    double worst = 0;
    for (const auto& [step, p] : by_step) {
      if (h.size() == 4) break;
      h.push_back(step);
      first.push_back(p.error("residual_first"));
      last.push_back(p.error("residual_last"));
      worst = std::max(worst, last.back() / first.back());
      c.points.push_back(p.id());
    }
    const Slope slope = log_log_slope(h, first), slope_last = log_log_slope(h, last);
    any = true;
    order = order && slope.high() >= 2;
    later = later && worst <= 1.1;
    c.measured += (c.measured.empty() ? "" : "; ") + std::string(scene) + ": slope of the first " +
                  text(slope) + ", of the last " + text(slope_last) + ", last over first at most " +
                  text(worst, 2);
  }
  if (any) c.verdict = order && later ? reproduced : order || later ? changed : not_reproduced;
}

void c8(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the same frame: fast projection and ICD at the same step and limit; reproduced if their "
      "errors in shape (potential energy, corner height, shadow; after the drape's valid_until) "
      "differ by less than 1 % of the cloth's size at every step of 0.005 s and below";
  std::map<std::pair<double, double>, Point> icd;
  const auto drape = [&](const char* solver) {
    return points.where([&](const Point& p) {
      return p.is("scene", "drape") && p.is("sweep", "step") && p.is("solver", solver) && p.ok() &&
             p.number("step") <= 0.005 && std::isfinite(p.error("shape_corner_height"));
    });
  };
  for (const Point& p : drape("icd"))
    icd.try_emplace({p.number("step"), p.number("strain_limit")}, p);
  double worst = -1;
  for (const Point& p : drape("fast_projection")) {
    const auto other = icd.find({p.number("step"), p.number("strain_limit")});
    if (other == icd.end()) continue;
    for (const char* shape : {"shape_potential_energy", "shape_corner_height", "shape_shadow"})
      worst = std::max(worst, std::abs(p.error(shape) - other->second.error(shape)));
    c.points.push_back(p.id());
    c.points.push_back(other->second.id());
  }
  if (worst < 0) return;
  c.measured = "largest difference " + percent(worst) + " over " +
               std::to_string(c.points.size() / 2) + " pairs";
  c.verdict = worst < 0.01 ? reproduced : not_reproduced;
}

void c11(const Points& points, ClaimVerdict& c) {
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

void c13(const Points& points, ClaimVerdict& c) {
  c.rule =
      "reproduced if the largest strain after the collision filter stays within 1.5 times the "
      "limit "
      "in every best run of fast projection; changed if within 1.5 times or 1 % of length, "
      "whichever is larger";
  bool tight = true, small = true;
  for (const auto& [limit, p] : points.best("drape", "strain", "fast_projection")) {
    const double after = p.number("max_strain_after_collision");
    if (!std::isfinite(after)) continue;
    c.points.push_back(p.id());
    tight = tight && after <= 1.5 * limit;
    small = small && after <= std::max(1.5 * limit, 0.01);
    c.measured += (c.measured.empty() ? "strain after collision: " : ", ") + percent(after) +
                  " at limit " + percent(limit);
  }
  if (!c.points.empty()) c.verdict = tight ? reproduced : small ? changed : not_reproduced;
}

void c15(const Points& points, ClaimVerdict& c) {
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

void c9(const Points& points, ClaimVerdict& c) {
  c.rule =
      "SHAKE refuses exactly Q1, Q2 and Q4 at the fixed step and with smaller ones; fast "
      "projection "
      "and ICD survive them, and Q3 at least with smaller steps; changed: SHAKE gets through some "
      "of "
      "them, or through with smaller steps";
  bool shake_always = true, shake_sometimes = false, others = true;
  std::string told;
  for (const char* q : {"Q1", "Q2", "Q3", "Q4"}) {
    for (const char* solver : {"shake", "fast_projection", "icd"}) {
      const json* cell = points.cell(q, solver);
      if (!cell) return;
      const std::string fixed = cell->at("at_fixed_step"), outcome = cell->at("outcome");
      c.points.push_back(std::string(q) + "/" + solver);
      if (solver == std::string("shake")) {
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

void c10(const Points& points, ClaimVerdict& c) {
  c.rule =
      "chain and cloth whose vertices are displaced before every step: fast projection, its BDF2 "
      "variant and ICD end every step within the strain limit";
  bool all = true;
  int cells = 0;
  double strain = 0;
  for (const json* cell : points.matrix()) {
    const std::string solver = cell->at("solver");
    if (cell->at("row") != "noise every step" ||
        (solver != "icd" && !solver.starts_with("fast_projection")))
      continue;
    ++cells;
    all = all && cell->at("at_fixed_step") == "survived";
    if (cell->at("max_strain").is_number())
      strain = std::max(strain, cell->at("max_strain").get<double>());
    c.points.push_back(cell->at("case").get<std::string>() + "/" + solver);
  }
  if (cells == 0) return;
  c.measured = "largest strain after any step " + percent(strain) + " (limit 1 %)";
  c.verdict = all ? reproduced : not_reproduced;
}

void c14(const Points& points, ClaimVerdict& c) {
  c.rule =
      "degrees of freedom per vertex (3 less the rank of J over the vertices, SuiteSparseQR): with "
      "quads within 25 % of 1 on the largest mesh, with triangles below a fifth of that";
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

struct Row {
  const char* id;
  const char* where;
  const char* statement;
  void (*judge)(const Points&, ClaimVerdict&);  // null: no measurement decides it yet
};

constexpr Row rows[] = {
    {"C1", "Fig. 4a",
     "chain: fast projection is asymptotically better than implicit springs as strain falls", c1},
    {"C2", "Fig. 4b",
     "chain at 1 %: fast projection scales better with resolution than implicit springs", c2},
    {"C3", "Sec. 5", "chain of 80 at 1 %: fast projection is 25 times faster", c3},
    {"C4", "Sec. 5", "drape: the stiffness that meets a small strain cannot be set a priori", c4},
    {"C5", "Fig. 5a",
     "drape: SHAKE, ICD and fast projection scale alike and better than strain limiting; fast "
     "projection is fastest of them",
     c5},
    {"C6", "Fig. 5b", "drape at 1 %: fast projection beats all others at every resolution", c6},
    {"C7", "Fig. 3",
     "the first iteration removes the first-order part of F; later ones change it at higher order, "
     "often downwards; F is O(h^2)",
     c7},
    {"C8", "Fig. 6", "the same frame from fast projection and ICD looks alike", c8},
    {"C9", "Fig. 2", "SHAKE fails in Q1, Q2 and Q4 at any step; fast projection and ICD do not",
     c9},
    {"C10", "Sec. 2, 6", "no drift: constraint error does not accumulate", c10},
    {"C11", "Sec. 4.3", "fast projection's matrix is smaller than ICD's, definite, and sparser",
     c11},
    {"C12", "Fig. 1",
     "a patch pinned at two corners sags visibly differently at 10 %, 1 % and less", nullptr},
    {"C13", "Sec. 6", "strain stays negligible after the collision filter too", c13},
    {"C14", "Sec. 3",
     "quads keep about n degrees of freedom, triangles with all edges constrained lock", c14},
    {"C15", "Sec. 5", "SHAKE needs very small, cheap steps; ICD takes larger, dear ones", c15},
    {"C16", "Fig. 7",
     "with small strain a tight garment does not slip past a narrowing of the body", nullptr},
};

}  // namespace

std::vector<ClaimVerdict> judge_claims(const std::vector<json>& results) try {
  const Points points(results);
  std::vector<ClaimVerdict> claims;
  for (const Row& row : rows) {
    ClaimVerdict claim{row.id, row.where, row.statement, not_measured, "", "", {}};
    if (row.judge) row.judge(points, claim);
    if (claim.verdict == not_measured) {
      claim.points.clear();
      claim.measured.clear();
    }
    claims.push_back(std::move(claim));
  }
  return claims;
} catch (const json::exception& error) {
  throw UsageError(std::string("a result file lacks something: ") + error.what());
}

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
  for (const auto& c : claims) {
    out << c.id << " (" << c.where << "): " << c.statement << "\n  " << c.verdict;
    if (!c.measured.empty()) out << ": " << c.measured;
    out << '\n';
    if (!c.rule.empty()) out << "  rule: " << c.rule << '\n';
    constexpr std::size_t shown = 4;
    for (std::size_t i = 0; i < std::min(shown, c.points.size()); ++i)
      out << (i == 0 ? "  points: " : "          ") << c.points[i] << '\n';
    if (c.points.size() > shown) out << "          and " << c.points.size() - shown << " more\n";
    out << '\n';
  }
}

void print_claims_markdown(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
  out << "| | claim | verdict | measured |\n|---|---|---|---|\n";
  for (const auto& c : claims) {
    out << "| " << c.id << ", " << c.where << " | " << c.statement << " | " << c.verdict << " | "
        << c.measured << " |\n";
  }
}

}  // namespace harness
