// Masses of unlike vertices.
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;

namespace {

const Expectation implicit_end{end_direction, survives, "implicit in the tension"};
const Expectation implicit_springs{springs, survives, "implicit in the tension"};

// Light beads on a string that a mass `ratio` times theirs pulls taut: their transverse waves have
// omega = 2 (T / (m l))^1/2. A constraint direction that is known before the step's end is explicit
// for them, and stable up to omega h = 2.
std::vector<Expectation> heavy_end(double ratio) {
  // T = 1.4 m/s^2 times the heavy mass after 0.1 s, l = 0.05 m, h = 1/400 s
  const double omega_h = 2 * std::sqrt(1.4 * ratio / 0.05) / 400;
  const Expectation start =
      omega_h < 1 ? Expectation{start_direction, survives, "transverse waves with omega h < 1"}
                  : Expectation{start_direction,
                                refuses,
                                "transverse waves with omega h > 2 grow until links turn by 60 "
                                "degrees in a step, where no solution exists",
                                {{survives, "the string's own length bounds how far they grow"}}};
  return {start,
          {strain_limiting, survives,
           "only the last edge is slow, and nothing pulls at it: the end falls freely"},
          {everyone, survives, "a direct solve does not mind"}};
}

// In a pass a multiplier moves a heavy vertex by multiplier_penalty / ratio of its edge's
// elongation, at both of its edges: dual methods mind the ratio of masses (Macklin et al. 2020).
Expectation multipliers_between(double ratio) {
  const double passes = 5 * ratio / (2 * multiplier_penalty);  // to 1 % of a load: 5 e-foldings
  if (passes < 1e5)
    return {multipliers, survives, "passes grow with the ratio, up to some thousand"};
  if (passes > 1e6)
    return {multipliers, refuses, "passes grow with the ratio, far beyond the 1e5 allowed"};
  return {multipliers,
          refuses,
          "2.5e5 passes from no load, where 1e5 are allowed",
          {{survives, "the last step's multipliers leave a part of these"}}};
}

std::vector<Expectation> light_between(double ratio) {
  // T = 0.5 N, l = 0.05 m, a light mass of 0.048 kg / ratio, h = 1/400 s
  const double square = 4 * 0.5 * ratio / (0.048 * 0.05) / (400.0 * 400);  // (omega h)^2
  if (square < 2)
    return {multipliers_between(ratio),
            implicit_end,
            implicit_springs,
            {strain_limiting, survives, "some hundred passes times 1 + ln(ratio)"},
            {everyone, survives, "transverse waves with omega h < 2"}};
  if (square > 1000)
    return {multipliers_between(ratio),
            implicit_end,
            implicit_springs,
            {strain_limiting, refuses, "passes grow with the ratio, beyond the 1e5 allowed"},
            {{"yarn_projection@bdf2", "fast_projection_adaptive@bdf2"},
             refuses,
             "as for everyone below",
             {{survives,
               "yarns are brought to 0.8 of the limit: whether a wave leaves the room "
               "that is left to it is up to rounding"}}},
            {everyone, refuses,
             "transverse waves overshoot more than thousandfold in a step: no direction that is "
             "not implicit follows them"}};
  return {
      multipliers_between(ratio),
      implicit_end,
      implicit_springs,
      {strain_limiting,
       survives,
       "as many passes as the ratio, a tenth of those allowed",
       {{refuses, "ten times the ratio is as good an estimate"}}},
      {everyone,
       refuses,
       "transverse waves with omega h > 2 grow",
       {{survives,
         "within the limit a bead has room for a tenth of an edge, and waves stay within it"}}}};
}

}  // namespace

void add_mass_ratios(std::vector<HardCase>& cases, const HardCaseValues& values) {
  for (const double ratio : values.at("ratios")) {
    cases.push_back({"heavy end", "heavy_end/" + number_text(ratio), "last vertex heavier by this",
                     [ratio] {
                       Mesh mesh = chain(20);
                       mesh.parts.mass.back() *= ratio;
                       return trial_of(std::move(mesh), 1.0 / 400, 40);
                     },
                     heavy_end(ratio)});
    cases.push_back({"light between heavy", "light_between/" + number_text(ratio),
                     "every other vertex lighter by this",
                     [ratio] {
                       Mesh mesh = chain(20);
                       for (std::size_t i = 1; i < 20; i += 2) mesh.parts.mass[i] /= ratio;
                       Trial trial = trial_of(std::move(mesh), 1.0 / 400, 40);
                       trial.slack = std::sqrt(3 * trial.strain_limit / 8) *
                                     0.1;  // two links between heavy ends
                       return trial;
                     },
                     light_between(ratio)});
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
                     {{everyone, survives,
                       "in 0.1 s it falls by half an edge, and only what is next to the pin is "
                       "pulled: the weight falls freely"}}});
  }
}

}  // namespace harness
