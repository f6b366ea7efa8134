#include <algorithm>

#include "harness/stability/checks.h"

namespace harness {

using inextensible::State;

Findings check_determinism(const Examinee& solver) {
  const Case other = net(9, 4, 1, 2, 0.005, 1, 0.005);
  std::string difference;
  int steps = 0;
  for (const Case& c : {net(5, 5, 2, 2, 0.0025, 20, 0.005),
                        scene_case("drape of 9 x 9", "drape", solver.drape(9), 1.0 / 800, 40)}) {
    const auto alone = solver.stepper(c);
    std::vector<State> path;
    State state = c.scene.start;
    for (int i = 0; i < c.steps; ++i) {
      alone->advance(state, c.step);  // refusals must repeat as well
      path.push_back(state);
    }
    const auto again = solver.stepper(c), neighbour = solver.stepper(other);
    State theirs = other.scene.start;
    state = c.scene.start;
    for (std::size_t i = 0; i < path.size(); ++i, ++steps) {
      again->advance(state, c.step);
      neighbour->advance(theirs, other.step);
      if (difference.empty() && !same_bits(state, path[i]))
        difference = text("positions or velocities differ by ",
                          std::max((state.x - path[i].x).cwiseAbs().maxCoeff(),
                                   (state.v - path[i].v).cwiseAbs().maxCoeff()),
                          " at ", c.name, ", step ", i + 1);
    }
    if (difference.empty() && !(again->work() == alone->work()))
      difference = "counters differ at " + c.name;
  }
  return {judged(
      difference.empty(), "determinism",
      text(steps, " steps repeated beside another instance: ",
           difference.empty() ? "the same bits and counters" : difference),
      "one seed, one result: no static or global state, no clock, no std::rand, no memory that "
      "was not initialized, no order of addresses; random numbers from BackendOptions::seed")};
}

}  // namespace harness
