// Long chains and large cloths.
#include <algorithm>
#include <cmath>

#include "harness/stability/case_expectations.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case_families.h"

namespace harness {

using namespace case_parts;

void add_large(std::vector<HardCase>& cases, const HardCaseValues& values) {
  const auto budget = [](Trial& trial) {  // edge visits that strain limiting may spend on a step
    const double passes = std::max(100.0, 2e8 / trial.scene.problem->constraints());
    for (const auto& backend : inextensible::backends())
      if (backend.direction == strain_limiting && inextensible::is_built_in(backend.name))
        trial.settings[backend.name] = {{"max_iterations", std::min(1e5, std::floor(passes))}};
  };
  for (const double value : values.at("links")) {
    const int n = static_cast<int>(value);
    cases.push_back({"long chain",
                     "chain/" + std::to_string(n),
                     "this many links, falling, h = 1/400 s",
                     [n, budget] {
                       Trial trial = trial_of(chain(n), 1.0 / 400, 10);
                       budget(trial);
                       return trial;
                     },
                     {{strain_limiting, slow, "information travels an edge a pass"},
                      {start_direction, slow, "links turn farther in a step the shorter they are"},
                      {everyone, slow, ""}}});
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
                     {{everyone, slow, ""}}});
  }
}

}  // namespace harness
