#include "harness/stability/checks.h"

namespace harness {

using inextensible::State;
using inextensible::StepResult;

Findings check_refusal(const Examinee& solver) {
  Case torn = scene_case("a row between pins 20 % farther apart than it is long", "taut_row",
                         {{"stretch", 1.2}, {"n", 12}}, 0.01, 1);
  Case overflow = net(1, 4, 1, 2, 0.01, 1, 0.005);
  overflow.name = "speeds of 1e300 m/s";
  overflow.scene.start.v *= 1e300;
  int refused = 0, accepted = 0;
  std::string wrong;
  for (const Case* c : {&torn, &overflow}) {
    State state = c->scene.start;
    state.time = 2;
    const State before = state;
    const StepResult result = solver.stepper(*c)->advance(state, c->step);
    if (result) {
      ++accepted;
      if (!state.x.allFinite() || !state.v.allFinite()) {
        wrong = c->name + ": a state that is not finite was accepted; test what you return";
      } else if (c == &torn && solver.keeps_a_limit()) {
        wrong = c->name + ": accepted, although no positions keep the limit";
      }
      continue;
    }
    ++refused;
    if (!same_bits(state, before))
      wrong = c->name +
              ": the refused step changed the state; work on copies, x_start is not "
              "yours, and a step controller repeats the step from it";
    else if (std::string(result.detail).empty())
      wrong = c->name + ": refused without a reason in StepResult::detail";
  }
  return {judged(wrong.empty(), "refusal",
                 text(refused, " impossible steps refused, ", accepted,
                      " taken with finite positions; state bit for bit as it was: ",
                      wrong.empty() ? "yes" : "no, or not refused"),
                 wrong)};
}

}  // namespace harness
