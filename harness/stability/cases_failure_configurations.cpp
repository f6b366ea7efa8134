// Q1 to Q4 (Goldenthal et al. 2007, Figure 2): weightless, one step that takes vertices to given
// candidates.
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/case_expectations.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case_families.h"

namespace harness {

using namespace case_parts;
using inextensible::Positions;

namespace {

constexpr double q_step = 0.01, q_limit = 1e-6;

Trial one_step(Mesh mesh, const Positions& candidate) {
  mesh.parts.gravity.setZero();
  mesh.start.v = (candidate - mesh.start.x) / q_step;
  Trial trial = trial_of(std::move(mesh), q_step, 1, q_limit);
  trial.settings["implicit_springs"] = {{"stiffness", 1e6}};
  trial.energy_tolerance = closest_point_energy;
  trial.slack = std::sqrt(2 * q_limit);  // sideways, of an edge pulled taut
  return trial;
}

// An edge of 1 m along x, pinned at the origin; its free end goes to (x, y).
Trial one_edge(double x, double y) {
  Mesh mesh = points(2, 1);
  mesh.start.x(0, 1) = 1;
  mesh.parts.pinned = {0};
  join(mesh, 0, 1, 1);
  Positions candidate = mesh.start.x;
  candidate.col(1) << x, y, 0;
  return one_step(std::move(mesh), candidate);
}

// Two edges of 1 m from pins at (-half_span, 0) and (half_span, 0) to a vertex between them that
// goes from (0, y) to (0, candidate_y).
Trial two_edges(double half_span, double y, double candidate_y) {
  Mesh mesh = points(3, 1);
  mesh.start.x.col(0) << -half_span, 0, 0;
  mesh.start.x.col(1) << 0, y, 0;
  mesh.start.x.col(2) << half_span, 0, 0;
  mesh.parts.pinned = {0, 2};
  join(mesh, 0, 1, 1);
  join(mesh, 1, 2, 1);
  Positions candidate = mesh.start.x;
  candidate(1, 1) = candidate_y;
  return one_step(std::move(mesh), candidate);
}

void add_exact(std::vector<HardCase>& cases) {
  cases.push_back({"Q1",
                   "Q1",
                   "an edge turns by 90 degrees and doubles its length",
                   [] { return one_edge(0, 2); },
                   {{start_direction, refuses, "no multiple of the old direction reaches length l"},
                    {everyone, survives, "the edge shortens along its own direction"}}});
  cases.push_back(
      {"Q2",
       "Q2",
       "an edge turns by 90 degrees: J(x0) W J(x^n)^T = 0",
       [] { return one_edge(0, 0.5); },
       {{start_direction, either,
         "Newton's own matrix is singular; the one frozen at x^n (Barth et al. 1994) is "
         "not, and may reach the solution that exists"},
        {everyone, survives, "J W J^T with one J is regular"}}});
  cases.push_back(
      {"Q3",
       "Q3",
       "two edges made parallel by the step: J(x0) is rank deficient",
       [] { return two_edges(0.6, 0.8, 0); },
       {{start_direction, either, "J(x^n) is regular"},
        {{"implicit_springs"}, either, "a saddle of the energy"},
        {everyone, either,
         "no direction at x0 changes both lengths, save by rounding; a smaller step has one"}}});
  cases.push_back({"Q4",
                   "Q4",
                   "a straight chain between two pins: J(x^n) is rank deficient",
                   [] { return two_edges(1, 0, 0.01); },
                   {{start_direction, refuses, "J(x^n) W J(x^n)^T is singular"},
                    {strain_limiting, slow, "taut: convergence slower than linear"},
                    {everyone, survives, "J(x^n) is not used"}}});
}

// At the distance d from the singular positions.
void add_near(std::vector<HardCase>& cases, double d) {
  cases.push_back(
      {"Q1 near",
       "Q1/" + number_text(d),
       "the candidate too long by this much only",
       [d] { return one_edge(0, 1 + d); },
       {{start_direction, either, "no solution beyond the limit"}, {everyone, survives, "as Q1"}}});
  cases.push_back({"Q2 near",
                   "Q2/" + number_text(d),
                   "J(x0) W J(x^n)^T of this size",
                   [d] { return one_edge(d, 0.5); },
                   {{start_direction, either, "nearly singular"}, {everyone, survives, "as Q2"}}});
  cases.push_back(
      {"Q3 near",
       "Q3/" + number_text(d),
       "the candidate beside the line of the pins",
       [d] { return two_edges(0.6, 0.8, 0.8 * d); },
       {{start_direction, either, "J(x^n) is regular"}, {everyone, either, "nearly singular"}}});
  cases.push_back({"Q4 near",
                   "Q4/" + number_text(d),
                   "a sagging chain between two pins",
                   [d] { return two_edges(std::sqrt(1 - d * d), d, d + 0.01); },
                   {{start_direction, either, "nearly singular"},
                    {{"icd"},
                     either,
                     "C = 0 is at full length, where its matrix is singular to 14 digits: "
                     "rounding decides, and differs between processors"},
                    {strain_limiting, slow, "as Q4"},
                    {everyone, survives, "as Q4"}}});
}

}  // namespace

void add_failure_configurations(std::vector<HardCase>& cases, const HardCaseValues& values) {
  add_exact(cases);
  for (const double d : values.at("distances")) add_near(cases, d);
}

}  // namespace harness
