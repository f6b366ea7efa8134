// Starts far from the manifold of inextensible positions.
#include <memory>
#include <random>

#include "harness/base/text.h"
#include "harness/stability/case_expectations.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case_families.h"

namespace harness {

using namespace case_parts;
using inextensible::State;

void add_far_starts(std::vector<HardCase>& cases, const HardCaseValues& values) {
  const std::vector<Expectation> expected{
      {start_direction, either, "no solution along old directions"},
      {strain_limiting, slow, ""},
      {everyone, either, "released energy may be large"}};
  const auto fast = [](Trial trial) {  // the release moves vertices by many edges a step
    trial.energy_tolerance = closest_point_energy;
    return trial;
  };
  for (const double scale : values.at("scales")) {
    cases.push_back({"far start", "scaled/" + number_text(scale), "a chain of 20 scaled by this",
                     [scale, fast] {
                       Mesh mesh = chain(20);
                       mesh.start.x *= scale;
                       return fast(trial_of(std::move(mesh), 1.0 / 100, 20));
                     },
                     expected});
  }
  cases.push_back({"far start", "noise",
                   "11 x 11 cloth, every vertex displaced by up to 30 % of an edge",
                   [] {
                     Mesh mesh = cloth(11);
                     mesh.parts.pinned = {0};
                     std::mt19937_64 random(7);
                     add_noise(mesh.start.x, mesh.parts.pinned, 0.03, random);
                     return trial_of(std::move(mesh), 1.0 / 100, 20);
                   },
                   expected});
  cases.push_back(
      {"noise every step",
       "drift/chain",
       "every step of a hanging chain starts with errors of up to 10 % of an edge (C10)",
       [] {
         Trial trial = trial_of(chain(20, {0, -1, 0}), 1.0 / 100, 200);
         trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
           add_noise(state.x, {0}, 0.005, *random);
         };
         return trial;
       },
       {{start_direction, either, "directions of a disturbed start"},
        {everyone, survives, "each step begins anew: no drift"}}});
  cases.push_back({"noise every step",
                   "drift/cloth",
                   "the same for an 11 x 11 cloth, 5 % of an edge",
                   [] {
                     Mesh mesh = cloth(11);
                     mesh.parts.pinned = {0};
                     Trial trial = trial_of(std::move(mesh), 1.0 / 100, 50);
                     trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state,
                                                                                     int) {
                       add_noise(state.x, {0}, 0.005, *random);
                     };
                     return trial;
                   },
                   {{everyone, either, ""}}});
}

}  // namespace harness
