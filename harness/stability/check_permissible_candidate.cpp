#include <algorithm>
#include <variant>

#include "harness/judge/mechanics.h"
#include "harness/stability/checks.h"
#include "solvers/problem/forces.h"

namespace harness {

using inextensible::Positions;
using inextensible::State;
using inextensible::WorkCounters;

Findings check_permissible_candidate(const Examinee& solver) {
  const char* check = "permissible candidate";
  // A setting of this name means the same in every row (setting_fields.h), plug-ins' too.
  for (const auto& setting : solver.backend.settings) {
    if (setting.name == std::string("min_iterations") && std::get<double>(setting.initial) > 0)
      return {not_applicable(check, "corrected too, by its setting min_iterations")};
  }
  if (!solver.keeps_a_limit()) return {not_applicable(check, "no limit of its own")};
  double moved = 0, worst = 0, worst_candidate = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Case c = net(seed, 5, 1, 0.1, 0.01, 1, 0.05);
    State state = c.scene.start;
    WorkCounters nobodys;
    Positions candidate;
    inextensible::unconstrained_step(*c.scene.problem, state, c.step, candidate, nobodys);
    if (!solver.stepper(c)->advance(state, c.step))
      return {judged(false, check, "refused", "there is nothing to correct: return ok at once")};
    moved = std::max(moved, (state.x - candidate).cwiseAbs().maxCoeff());
    worst = std::max(worst, worst_edge(*c.scene.problem, state.x).strain);
    worst_candidate = std::max(worst_candidate, worst_edge(*c.scene.problem, candidate).strain);
  }
  return {judged(moved == 0 || worst <= worst_candidate, check,
                 moved == 0 ? "left alone"
                            : text("moved by up to ", moved, " m; largest strain ", worst,
                                   " (the candidate's, allowed: ", worst_candidate, ")"),
                 "a correction of what keeps the limit made it worse: test the candidate first")};
}

}  // namespace harness
