// Starts far from the manifold of inextensible positions, and whether errors pile up over steps.
#include <memory>
#include <random>

#include "harness/base/text.h"
#include "harness/stability/case_expectations.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case_families.h"

namespace harness {

using namespace case_parts;
using inextensible::State;

namespace {

// At the pin all weight pulls at one vertex's mass: transverse waves of the string there have
// omega = 2 (T / (m l))^1/2. A constraint direction from the start of the step is explicit for
// them.
const Expectation stiff_waves{start_direction, refuses,
                              "transverse waves beside the pin with omega h > 2 grow until links "
                              "turn by 60 degrees in a step"};

Trial ten_seconds(Mesh mesh) { return trial_of(std::move(mesh), 1.0 / 100, 1000); }

}  // namespace

void add_far_starts(std::vector<HardCase>& cases, const HardCaseValues& values) {
  // The release throws the ends at 50 m/s past the places where they belong, and back again.
  const char* thrown =
      "the release throws the chain through itself: what it looks like after a few steps follows "
      "from how gravity buckles it, which amplifies rounding";
  const std::vector<Expectation> expected{
      {strain_limiting, survives, "each edge is corrected along itself, from any position"},
      {start_direction, refuses, "links turn over in a step", {{survives, thrown}}},
      {springs, survives, "the energy has a minimum", {{refuses, thrown}}},
      {everyone,
       survives,
       "close to any position there are permissible ones",
       {{refuses, thrown}}}};
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
  cases.push_back(
      {"far start",
       "noise",
       "11 x 11 cloth, every vertex displaced by up to 30 % of an edge",
       [] {
         Mesh mesh = cloth(11);
         mesh.parts.pinned = {0};
         std::mt19937_64 random(7);
         add_noise(mesh.start.x, mesh.parts.pinned, 0.03, random);
         return trial_of(std::move(mesh), 1.0 / 100, 20);
       },
       {{start_direction,
         refuses,
         "corrections of a third of an edge along directions of the start: nothing says "
         "that a solution exists",
         {{survives, "nor that none does"}}},
        {everyone, survives, "close to any position there are permissible ones"}}});
  cases.push_back(
      {"noise every step",
       "drift/chain",
       "every step of a hanging chain starts with errors of up to 10 % of an edge (C10)",
       [] {
         Trial trial = ten_seconds(chain(20, {0, -1, 0}));
         trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
           add_noise(state.x, {0}, 0.005, *random);
         };
         return trial;
       },
       {{start_direction, refuses,
         "each step's noise leaves velocities of 0.3 m/s, which nothing damps: after a second "
         "links "
         "turn by 60 degrees in a step"},
        {everyone, survives, "each step begins anew: no drift"}}});
  cases.push_back({"noise every step",
                   "drift/cloth",
                   "the same for an 11 x 11 cloth, 5 % of an edge",
                   [] {
                     Mesh mesh = cloth(11);
                     mesh.parts.pinned = {0};
                     Trial trial = ten_seconds(std::move(mesh));
                     trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state,
                                                                                     int) {
                       add_noise(state.x, {0}, 0.005, *random);
                     };
                     return trial;
                   },
                   {stiff_waves, {everyone, survives, "each step begins anew: no drift"}}});
  for (const bool cloth_swings : {false, true}) {
    cases.push_back({"ten seconds",
                     cloth_swings ? "swing/cloth" : "swing/chain",
                     cloth_swings
                         ? "an 11 x 11 cloth held at one corner swings for 10 s, h = 1/100 s"
                         : "a chain of 20 swings for 10 s, h = 1/100 s (C10)",
                     [cloth_swings] {
                       Mesh mesh = cloth_swings ? cloth(11) : chain(20);
                       mesh.parts.pinned = {0};
                       return ten_seconds(std::move(mesh));
                     },
                     {stiff_waves, {everyone, survives, "each step begins anew: no drift"}}});
  }
}

}  // namespace harness
