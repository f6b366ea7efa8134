// Which of the runs that were measured on a scene its user should take, and what more or less
// computation would bring.
#pragma once

#include <optional>
#include <vector>

#include "harness/points/point.h"

namespace harness {

struct Wish {
  double error = headline_error;  // over the scene's size; any_motion: whatever it looks like
  double rate = 60;               // frames a second: one that frame times are kept of
};

struct Pick {
  const PointResult* point = nullptr;
  FrameTime frame;
  double error = unknown;  // over the scene's size; unknown: nothing says
};

// The fastest that ran to the end within strain limit and error; `not_by`: of other contestants.
std::optional<Pick> fastest(const std::vector<PointResult>& points, const Wish& wish,
                            const std::string& not_by = {});

// The least error of those whose frames take `seconds` at most, 99 of 100 of them. Where nothing is
// known of errors, the one with the smallest step.
std::optional<Pick> most_accurate(const std::vector<PointResult>& points, const Wish& wish,
                                  double seconds);

}  // namespace harness
