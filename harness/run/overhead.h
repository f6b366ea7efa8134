// What the harness adds to the time of a step.
#pragma once

namespace harness {

// What a timed step costs beyond the step, in seconds: the runner's time for steps of the solver
// `null` on two vertices, less the time of the same steps called one after the other.
double harness_seconds_per_step();

}  // namespace harness
