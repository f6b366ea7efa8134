// Masses of unlike vertices.
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/case_expectations.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case_families.h"

namespace harness {

using namespace case_parts;

void add_mass_ratios(std::vector<HardCase>& cases, const HardCaseValues& values) {
  for (const double ratio : values.at("ratios")) {
    const std::vector<Expectation> expected{
        {strain_limiting, slow, "convergence slows with the ratio"},
        {start_direction, either, ""},
        {everyone, survives, "a direct solve does not mind"}};
    cases.push_back({"heavy end", "heavy_end/" + number_text(ratio), "last vertex heavier by this",
                     [ratio] {
                       Mesh mesh = chain(20);
                       mesh.parts.mass.back() *= ratio;
                       return trial_of(std::move(mesh), 1.0 / 400, 40);
                     },
                     expected});
    cases.push_back({"light between heavy",
                     "light_between/" + number_text(ratio),
                     "every other vertex lighter by this",
                     [ratio] {
                       Mesh mesh = chain(20);
                       for (std::size_t i = 1; i < 20; i += 2) mesh.parts.mass[i] /= ratio;
                       Trial trial = trial_of(std::move(mesh), 1.0 / 400, 40);
                       trial.slack = std::sqrt(3 * trial.strain_limit / 8) *
                                     0.1;  // two links between heavy ends
                       return trial;
                     },
                     {{{"icd", "implicit_springs"}, survives, "implicit in the tension"},
                      {everyone, slow,
                       "light beads on a taut string: transverse waves too stiff for a constraint "
                       "direction that is not implicit"}}});
    cases.push_back({"heavy patch",
                     "heavy_patch/" + number_text(ratio),
                     "11 x 11 cloth pinned closer, its middle 3 x 3 heavier by this",
                     [ratio] {
                       Mesh mesh = cloth(11);
                       mesh.parts.pinned = {0};
                       for (int i = 4; i < 7; ++i)
                         for (int j = 4; j < 7; ++j) mesh.parts.mass[11 * i + j] *= ratio;
                       return trial_of(std::move(mesh), 1.0 / 400, 40);
                     },
                     {{strain_limiting, slow, "convergence slows with the ratio"},
                      {everyone, either, "rows tighten like ropes around the weight"}}});
  }
}

}  // namespace harness
