// A short look at a contestant: its first steps on a scene, to see how fast it is before any run
// to the end.
#pragma once

#include "harness/run/measure_point.h"

namespace harness {

inline constexpr double usual_look = 0.1;  // s

// Takes steps for about limits.hopeless seconds. The point's one sample is their time, where one
// step succeeded, and its status is ok if they met the strain limit. Springs have the stiffness
// that a calibration begins with; their strain says nothing yet and counts as met.
PointResult screen_point(const PointSpec& spec, const RunLimits& limits,
                         std::optional<double> guess = {});

}  // namespace harness
