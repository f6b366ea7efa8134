// Rows at full length between pins, and constraints that cannot be met.
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/case_expectations.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case_families.h"

namespace harness {

using namespace case_parts;

void add_taut(std::vector<HardCase>& cases, const HardCaseValues& values) {
  const auto row = [](double stretch) {
    return scene_of("taut_row", {{"stretch", stretch}, {"duration", 0.5}});
  };
  // A row of 1 m that is strained by s sags by sqrt(3 s / 8) m.
  const auto taut = [](Trial trial) {
    trial.slack = std::sqrt(3 * trial.strain_limit / 8);
    return trial;
  };
  for (const double limit : values.at("limits")) {
    cases.push_back({"taut row",
                     "taut_row/" + number_text(limit),
                     "30 links straight between pins, falling; strain limit " + number_text(limit),
                     [=] { return taut(trial_of(row(1), 1.0 / 200, limit)); },
                     {{start_direction, either, "J(x^n) is singular at the start (Q4)"},
                      {current_direction, survives, "the permissible band has an interior"},
                      {everyone, slow, "information travels an edge a pass"}}});
    cases.push_back({"1 m patch",
                     "patch/" + number_text(limit),
                     "15 x 15 cloth, pinned 1 m apart, falling; strain limit " + number_text(limit),
                     [=] {
                       return taut(trial_of(scene_of("patch", {{"n", 15}, {"duration", 0.5}}),
                                            1.0 / 400, limit));
                     },
                     {{start_direction, either, "J(x^n) is singular at the start (Q4)"},
                      {{"icd"}, either, "at full length no multipliers exist"},
                      {current_direction, survives, "Figure 1 of the paper"},
                      {everyone, slow, "information travels an edge a pass"}}});
  }
  const std::vector<Expectation> impossible{{springs, survives, "springs stretch"},
                                            {everyone, refuses, "nothing can satisfy it"}};
  cases.push_back({"infeasible", "infeasible/row", "pins 20 % farther apart than the row is long",
                   [=] {
                     Trial trial = trial_of(row(1.2), 1.0 / 100);
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
  cases.push_back({"triangles",
                   "triangles",
                   "9 x 9 cloth, all edges of its triangles constrained",
                   [=] { return taut(trial_of(cloth(9, true), 1.0 / 400, 100)); },
                   {{everyone, slow, "locked: about 4 n degrees of freedom instead of n^2"}}});
}

}  // namespace harness
