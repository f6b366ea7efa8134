#include "harness/claims/robustness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace harness::claims {

using nlohmann::json;

void springs_stiffness(const Points& points, ClaimVerdict& c) {
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

void failure_configurations(const Points& points, ClaimVerdict& c) {
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

void no_drift(const Points& points, ClaimVerdict& c) {
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

void degrees_of_freedom_left(const Points& points, ClaimVerdict& c) {
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

}  // namespace harness::claims
