// Large rotations and velocities in one step.
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;
using inextensible::State;

namespace {

// Hangs down by half of its length and goes up again.
Mesh folded_chain() {
  Mesh mesh = chain(40);
  const double gap = 1e-3;
  for (int i = 0; i <= 40; ++i)
    mesh.start.x.col(i) << (i > 20 ? gap * 20 : gap * i), -(i > 20 ? 40 - i : i) / 40.0, 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    mesh.parts.rest_length[k] = (mesh.start.x.col(e + 1) - mesh.start.x.col(e)).norm();
  }
  return mesh;
}

}  // namespace

void add_whip(std::vector<HardCase>& cases, const HardCaseValues& /*values*/) {
  const char* row = "whip";
  const Expectation everybody{everyone, survives,
                              "each edge keeps its own direction, however far it turns"};
  cases.push_back({row,
                   "crack",
                   "a folded chain, one end released: the tip outruns gravity",
                   [] { return trial_of(folded_chain(), 1.0 / 800, 400); },
                   {{start_direction, refuses,
                     "the last link of 25 mm turns over within two steps: more than 60 degrees in "
                     "one, where no multiple of the old direction reaches its length"},
                    everybody}});
  cases.push_back({row,
                   "spin",
                   "a free chain turning at 100 rad/s, 0.1 rad a step",
                   [] {
                     Mesh mesh = chain(20, {1, 0, 0}, false);
                     mesh.parts.gravity.setZero();
                     for (int i = 0; i <= 20; ++i) mesh.start.v(1, i) = 100 * (i / 20.0 - 0.5);
                     return trial_of(std::move(mesh), 1e-3, 200);
                   },
                   {{everyone, survives,
                     "0.1 rad in a step is little, and nothing outside acts: momentum is "
                     "conserved"}}});
  cases.push_back({row,
                   "hit",
                   "15 x 15 cloth, its middle vertex hit at 100 m/s",
                   [] {
                     Mesh mesh = cloth(15);
                     mesh.parts.pinned.clear();
                     mesh.start.v(1, 7 * 15 + 7) = 100;
                     Trial trial = trial_of(std::move(mesh), 1e-3, 100);
                     trial.energy_tolerance = closest_point_energy;
                     return trial;
                   },
                   {{start_direction, refuses,
                     "the vertex is 0.1 m above the others, edges are 0.07 m long, and all old "
                     "directions are horizontal (Q1)"},
                    everybody}});
  cases.push_back({row,
                   "jump",
                   "the pin of a hanging chain jumps by 10 edge lengths in one step",
                   [] {
                     Trial trial = trial_of(chain(20, {0, -1, 0}), 1.0 / 100, 20);
                     trial.disturb = [](State& state, int step) {
                       if (step == 5) state.x(0, 0) += 0.5;
                     };
                     return trial;
                   },
                   {{start_direction, refuses,
                     "the chain must move sideways by ten edges, and all old directions but one "
                     "are plumb (Q1)"},
                    everybody}});
}

}  // namespace harness
