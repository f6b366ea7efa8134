// Rows at full length between pins, and constraints that cannot be met.
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;

namespace {

const Expectation stretching{springs, survives, "springs stretch"};
const Expectation others{everyone, survives,
                         "springs stretch, and the permissible band has an interior"};

// A row of n links that sags within the strain limit s has slopes of about (6 s)^1/2; its slowest
// mode shrinks by (6 s) (pi / n)^2 a pass: e-fold in 1500 passes at 1 %, ten times as many at 0.1
// %.
Expectation passes_along_a_row(double limit) {
  if (limit > 0.005)
    return {strain_limiting, survives, "about 1e4 passes a step, where 1e5 are allowed"};
  return {strain_limiting,
          refuses,
          "about 1e5 passes a step, as many as are allowed, and one step of many may take more",
          {{survives, "the estimate is one of order: averaged and over-relaxed passes reach it"}}};
}

Scene row_of_links(double stretch) {
  return scene_of("taut_row", {{"stretch", stretch}, {"duration", 0.5}});
}

// A row of 1 m that is strained by s sags by sqrt(3 s / 8) m.
Trial taut(Trial trial) {
  trial.slack = std::sqrt(3 * trial.strain_limit / 8);
  return trial;
}

void add_between_pins(std::vector<HardCase>& cases, double limit) {
  const std::vector<Expectation> expected{
      {start_direction, refuses,
       "J(x^n) is singular at the start (Q4), and where the fall is stopped its "
       "directions lie along the row, the correction across it"},
      {end_direction,
       survives,
       "the permissible band has an interior",
       {{refuses,
         "at full length no multipliers exist: whether the band ends the iteration before "
         "depends on the path of Newton's steps"}}},
      {current_direction, survives,
       "the permissible band has an interior, which damped projections find"},
      passes_along_a_row(limit),
      others};
  cases.push_back({"taut row", "taut_row/" + number_text(limit),
                   "30 links straight between pins, falling; strain limit " + number_text(limit),
                   [=] { return taut(trial_of(row_of_links(1), 1.0 / 200, limit)); }, expected});
  cases.push_back(
      {"1 m patch", "patch/" + number_text(limit),
       "15 x 15 cloth, pinned 1 m apart, falling; strain limit " + number_text(limit),
       [=] {
         return taut(trial_of(scene_of("patch", {{"n", 15}, {"duration", 0.5}}), 1.0 / 400, limit));
       },
       expected});
}

void add_infeasible(std::vector<HardCase>& cases) {
  const std::vector<Expectation> impossible{stretching,
                                            {everyone, refuses, "nothing can satisfy it"}};
  cases.push_back({"infeasible", "infeasible/row", "pins 20 % farther apart than the row is long",
                   [] {
                     Trial trial = trial_of(row_of_links(1.2), 1.0 / 100);
                     trial.steps = 3;
                     return trial;
                   },
                   impossible});
  cases.push_back({"infeasible", "infeasible/duplicate", "one edge twice, lengths 1 and 1.1",
                   [] {
                     Mesh mesh = chain(1);
                     join(mesh, 0, 1, 1.1);
                     return trial_of(std::move(mesh), 0.01, 3);
                   },
                   impossible});
}

void add_triangles(std::vector<HardCase>& cases) {
  cases.push_back({"triangles",
                   "triangles",
                   "9 x 9 cloth, all edges of its triangles constrained",
                   [] { return taut(trial_of(cloth(9, true), 1.0 / 400, 100)); },
                   {{start_direction, refuses,
                     "flat, more edges than coordinates in the plane: J(x^n) is rank deficient"},
                    {end_direction,
                     refuses,
                     "locked: no multipliers exist at C = 0, and Newton aims there",
                     {{survives, "the permissible band may end the iteration before"}}},
                    {current_direction, survives,
                     "locked, but the permissible band has an interior, which damped projections "
                     "find"},
                    passes_along_a_row(0.01),
                    others}});
  cases.push_back({"triangles",
                   "triangles/midpoints",
                   "the same triangles, constrained between the midpoints of their edges",
                   [] { return taut(trial_of(midpoint_cloth(9), 1.0 / 400, 100)); },
                   {{everyone, survives, "a hinge in each midpoint: nothing locks"}}});
}

}  // namespace

void add_taut(std::vector<HardCase>& cases, const HardCaseValues& values) {
  for (const double limit : values.at("limits")) add_between_pins(cases, limit);
  add_infeasible(cases);
  add_triangles(cases);
}

}  // namespace harness
