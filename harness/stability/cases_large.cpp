// Long chains and large cloths.
#include <algorithm>
#include <cmath>

#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;

namespace {

// After ten steps of 1/400 s a chain has fallen by 3.4 mm, that is by `links` / 300 links. So many
// hang from the pin, and seven times as many are turned beyond the limit of 1 %.
std::vector<Expectation> long_chain(int links) {
  const Expectation implicit{end_direction, survives, "implicit in the tension: all turn at once"};
  const Expectation energy{springs, survives, "a direct solve does not mind the number of links"};
  const Expectation start =
      links < 300 ? Expectation{start_direction, survives, "no link turns by 60 degrees in a step"}
                  : Expectation{start_direction, refuses,
                                "links beside the pin turn by more than 60 degrees in a step: no "
                                "multiple of their old directions reaches their length"};
  if (links < 3000)
    return {implicit,
            energy,
            start,
            {strain_limiting, survives, "an edge a pass, squared: some thousand passes at most"},
            {everyone, survives, "an edge an iteration: 30 of the 200 allowed at most"}};
  const Expectation small_steps{{"pbd_substeps"},
                                Outcome::diverged,
                                "a sweep carries a load by some edges: the first link follows the "
                                "pin's pull alone, and is torn to several times its length"};
  const Expectation soft_steps{{"soft_step"}, Outcome::diverged, small_steps.why};
  if (links > 30000)
    return {
        small_steps,
        soft_steps,
        {multipliers, refuses,
         "along the 340 links that hang a load goes by an edge a pass, squared: 1e5 passes, where "
         "their budget is 2000"},
        implicit,
        energy,
        start,
        {strain_limiting, refuses,
         "an edge a pass, squared: a million passes, where their budget is some thousand"},
        {everyone, refuses,
         "a kink moves by an edge an iteration: over the steps 300 to 2000 of 200 allowed"}};
  return {
      small_steps,
      {multipliers, survives,
       "along the 34 links that hang a load goes by an edge a pass, squared: some thousand passes "
       "of the 20000 in their budget"},
      implicit,
      energy,
      start,
      {strain_limiting,
       refuses,
       "an edge a pass, squared: 60000 passes, where their budget is 20000",
       {{survives, "the estimate is one of order, and relaxation gains a factor of some"}}},
      {everyone,
       refuses,
       "a kink moves by an edge an iteration: 240 links, 200 iterations allowed",
       {{survives, "34 of them hang straight, where a few iterations do"}}}};
}

}  // namespace

void add_large(std::vector<HardCase>& cases, const HardCaseValues& values) {
  // Edge visits that passes may spend on a step, and the iterations of projections.
  const auto budget = [](Trial& trial) {
    const double passes = std::max(100.0, 2e8 / trial.scene.problem->constraints());
    for (const auto& backend : inextensible::backends()) {
      if (!inextensible::is_built_in(backend.name) ||
          backend.strain_control != inextensible::StrainControl::strain_limit)
        continue;
      if (backend.direction == strain_limiting || multipliers.contains(backend.name))
        trial.settings[backend.name] = {{"max_iterations", std::min(1e5, std::floor(passes))}};
      if (backend.direction == current_direction)
        trial.settings[backend.name] = {{"max_iterations", 200.0}};
    }
  };
  for (const double value : values.at("links")) {
    const int n = static_cast<int>(value);
    cases.push_back({"long chain", "chain/" + std::to_string(n),
                     "this many links, falling, h = 1/400 s",
                     [n, budget] {
                       Trial trial = trial_of(chain(n), 1.0 / 400, 10);
                       budget(trial);
                       return trial;
                     },
                     long_chain(n)});
  }
  for (const double value : values.at("sides")) {
    const int n = static_cast<int>(value);
    cases.push_back({"large cloth",
                     "cloth/" + std::to_string(n),
                     "this many vertices a side, held at one corner, h = 1/400 s",
                     [n, budget] {
                       Mesh mesh = cloth(n);
                       mesh.parts.pinned = {0};
                       Trial trial = trial_of(std::move(mesh), 1.0 / 400, 10);
                       budget(trial);
                       return trial;
                     },
                     {{everyone, survives,
                       "in ten steps it falls by less than an edge, and only what is next to the "
                       "pin is pulled"}}});
  }
}

}  // namespace harness
