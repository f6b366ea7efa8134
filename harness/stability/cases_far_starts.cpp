// Starts far from the manifold of inextensible positions, and whether errors pile up over steps.
#include <memory>
#include <random>

#include "harness/base/text.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

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

// Held at one corner.
Mesh hung_cloth() {
  Mesh mesh = cloth(11);
  mesh.parts.pinned = {0};
  return mesh;
}

Trial ten_seconds(Mesh mesh) { return trial_of(std::move(mesh), 1.0 / 100, 1000); }

const Expectation no_drift{everyone, survives, "each step begins afresh: no drift"};

void add_scaled_chains(std::vector<HardCase>& cases, const std::vector<double>& scales) {
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
  for (const double scale : scales) {
    cases.push_back({"far start", "scaled/" + number_text(scale), "a chain of 20 scaled by this",
                     [scale] {
                       Mesh mesh = chain(20);
                       mesh.start.x *= scale;
                       Trial trial = trial_of(std::move(mesh), 1.0 / 100, 20);
                       // The release moves vertices by many edges a step.
                       trial.energy_tolerance = closest_point_energy;
                       return trial;
                     },
                     expected});
  }
}

void add_noisy_cloth(std::vector<HardCase>& cases) {
  cases.push_back(
      {"far start",
       "noise",
       "11 x 11 cloth, every vertex displaced by up to 30 % of an edge",
       [] {
         Mesh mesh = hung_cloth();
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
}

Trial with_noise_every_step(Trial trial) {
  trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
    add_noise(state.x, {0}, 0.005, *random);
  };
  return trial;
}

void add_noise_every_step(std::vector<HardCase>& cases) {
  const char* row = "noise every step";
  cases.push_back(
      {row,
       "drift/chain",
       "every step of a hanging chain starts with errors of up to 10 % of an edge (C10)",
       [] {
         return with_noise_every_step(ten_seconds(chain(20, {0, -1, 0})));
       },
       {{start_direction, refuses,
         "each step's noise leaves velocities of 0.3 m/s, which nothing damps: after a second "
         "links "
         "turn by 60 degrees in a step"},
        no_drift}});
  cases.push_back({row,
                   "drift/cloth",
                   "the same for an 11 x 11 cloth, 5 % of an edge",
                   [] { return with_noise_every_step(ten_seconds(hung_cloth())); },
                   {stiff_waves, no_drift}});
}

void add_ten_seconds(std::vector<HardCase>& cases) {
  const char* row = "ten seconds";
  cases.push_back({row,
                   "swing/chain",
                   "a chain of 20 swings for 10 s, h = 1/100 s (C10)",
                   [] { return ten_seconds(chain(20)); },
                   {stiff_waves, no_drift}});
  cases.push_back({row,
                   "swing/cloth",
                   "an 11 x 11 cloth held at one corner swings for 10 s, h = 1/100 s",
                   [] { return ten_seconds(hung_cloth()); },
                   {stiff_waves, no_drift}});
}

}  // namespace

void add_far_starts(std::vector<HardCase>& cases, const HardCaseValues& values) {
  add_scaled_chains(cases, values.at("scales"));
  add_noisy_cloth(cases);
  add_noise_every_step(cases);
  add_ten_seconds(cases);
}

}  // namespace harness
