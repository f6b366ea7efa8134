// Q1 to Q4 (Goldenthal et al. 2007, Figure 2): weightless, one step that takes vertices to given
// candidates.
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/cases.h"

namespace harness::cases {
namespace {

using inextensible::Positions;

// A power of two, so that the candidates on the singular positions are reached exactly.
constexpr double q_step = 1.0 / 128;
constexpr double q_limit = 5e-7;  // between two of the distances that hard_case_values() has

Trial one_step(Mesh mesh, const Positions& candidate) {
  mesh.parts.gravity.setZero();
  mesh.start.v = (candidate - mesh.start.x) / q_step;
  Trial trial = trial_of(std::move(mesh), q_step, 1, q_limit);
  trial.stiffness = 1e6;
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

// Fixed points of SHAKE's iteration with the matrix of x^n, from a calculation by hand.
constexpr const char* frozen_q2 =
    "with the matrix frozen at x^n (Barth et al. 1994) the iteration is s - (s^2 - 3/4) / 2, which "
    "contracts by 0.13 at the solution, though Newton's own matrix is singular";
constexpr const char* frozen_q3 =
    "J(x^n) is regular, and with its matrix y - (y^2 - 0.64) / 1.6 converges from 0";
constexpr const char* own_direction =
    "an edge can always change its length along its own direction";

void add_exact(Cases& cases) {
  cases.add("Q1", "Q1", "an edge turns by 90 degrees and doubles its length",
            [] { return one_edge(0, 2); },
            {refuse(start_direction, "no multiple of the old direction reaches length l"),
             survive(everyone, own_direction)});
  cases.add("Q2", "Q2", "an edge turns by 90 degrees: J(x0) W J(x^n)^T = 0",
            [] { return one_edge(0, 0.5); },
            {survive(start_direction, frozen_q2), survive(everyone, own_direction)});
  cases.add(
      "Q3", "Q3", "two edges made parallel by the step: J(x0) is rank deficient",
      [] { return two_edges(0.6, 0.8, 0); },
      {survive(start_direction, frozen_q3),
       survive(springs, "the saddle of the energy is a solution, and springs may be short"),
       survive({"@midpoint"}, "the edges are not parallel in the middle of the step"),
       refuse({"@bdf2"}, "no direction at x0 changes both lengths")
           .or_else(survives, "the candidate of a two-step formula misses the line by a rounding"),
       refuse(everyone, "no direction at x0 changes both lengths; a smaller step has one")});
  cases.add(
      "Q4", "Q4", "a straight chain between two pins: J(x^n) is rank deficient",
      [] { return two_edges(1, 0, 0.01); },
      {refuse(start_direction, "J(x^n) W J(x^n)^T is singular"),
       refuse(strain_limiting,
              "a pass takes y to y - k y^3, k from 0.9 to 2: some 5e5 passes, where 1e5 are "
              "allowed"),
       survive(end_direction, "J(x^n) is not used")
           .or_else(refuses,
                    "F = 0 has no multipliers at full length: the permissible band, or rounding, "
                    "ends the iteration before"),
       survive(everyone, "J(x^n) is not used")});
}

// A pivot that keeps less than 1e-10 of its diagonal entry counts as singular
// (ConstraintSystem::least_pivot); of two edges that part by d from one line it keeps about 4 d^2.
bool numerically_singular(double d) { return 4 * d * d < 1e-10; }

Expectation q4_of_end(double d) {
  if (!numerically_singular(d))
    return survive(end_direction, "y is halved until it is near d, where all is regular");
  return survive(end_direction, "J(x^n) is not used")
      .or_else(refuses,
               "C = 0 is at full length, where the matrix is singular to double precision: "
               "rounding decides, and differs between processors");
}

// A pass of strain limiting takes y to y - k y (y^2 - d^2), k from 0.9 (averaged, relaxed by 1.8)
// over 2 (one by one) to 18 (the same relaxed by 1.8).
Expectation q4_of_strain_limiting(double d) {
  if (d * d > 10 * q_limit)
    return survive(strain_limiting, "some 1 / (k d^2) passes, of the 1e5 that are allowed");
  if (d * d < 0.1 * q_limit)
    return refuse(strain_limiting, "as Q4: some 5e5 passes, where 1e5 are allowed");
  return refuse(strain_limiting, "3e5 passes without over-relaxation, where 1e5 are allowed")
      .or_else(survives, "7e4 with it");
}

// Multipliers mu of both edges take the vertex from y0 = d + 0.01 to y = y0 / (1 + 2 mu), and a
// pass adds at most multiplier_penalty y^2 / 2 to mu: y^2 = d^2 + 2 q_limit takes at least
// ((y0 / y)^3 - 1) / (3 multiplier_penalty y0^2) passes.
Expectation q4_of_multipliers(double d) {
  const double from = d + 0.01, to = std::sqrt(d * d + 2 * q_limit);
  const double passes = (std::pow(from / to, 3) - 1) / (3 * multiplier_penalty * from * from);
  if (passes > 1e5)
    return refuse(multipliers,
                  "multipliers grow by less than 5 y^2 a pass: beyond the 1e5 allowed");
  return survive(multipliers, "some thousand passes");
}

// At the distance d from the singular positions.
void add_near(Cases& cases, double d) {
  const bool singular = numerically_singular(d);
  cases.add("Q1 near", "Q1/" + number_text(d), "the candidate too long by this much only",
            [d] { return one_edge(0, 1 + d); },
            {d > q_limit ? refuse(start_direction, "as Q1: no solution within the limit")
                         : survive(start_direction, "the candidate keeps the limit"),
             survive(everyone, own_direction)});
  cases.add("Q2 near", "Q2/" + number_text(d), "J(x0) W J(x^n)^T of this size",
            [d] { return one_edge(d, 0.5); },
            {survive(start_direction, frozen_q2), survive(everyone, own_direction)});
  const char* multiplied =
      "Newton's first step of 0.4 / d is halved at most 12 times, and has then "
      "lowered |C|";
  cases.add(
      "Q3 near", "Q3/" + number_text(d), "the candidate beside the line of the pins",
      [d] { return two_edges(0.6, 0.8, 0.8 * d); },
      {survive(start_direction, frozen_q3),
       survive(strain_limiting, "corrections of the too short edges multiply y in every pass"),
       survive(multipliers, "what pushes the too short edges apart multiplies y in every pass"),
       singular ? refuse(end_direction, "the Newton matrix is singular in double precision")
                : survive(end_direction, multiplied),
       survive(current_direction, "a damped projection multiplies y until |C| falls"),
       survive(everyone, "springs may be short")});
  cases.add("Q4 near", "Q4/" + number_text(d), "a sagging chain between two pins",
            [d] { return two_edges(std::sqrt(1 - d * d), d, d + 0.01); },
            {singular ? refuse(start_direction, "J(x^n) W J(x^n)^T is singular to ten digits")
                      : survive(start_direction, "J(x^n) is regular, and Newton halves y"),
             q4_of_multipliers(d), q4_of_end(d), q4_of_strain_limiting(d),
             survive(everyone, "J(x^n) is not used")});
}

}  // namespace

void add_failure_configurations(Cases& cases) {
  add_exact(cases);
  for (const double d : cases.values.at("distances")) add_near(cases, d);
}

}  // namespace harness::cases
