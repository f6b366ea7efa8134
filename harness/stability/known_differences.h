// Outcomes of hard cases that are not what theory expects, that are known, and why they are so.
#pragma once

#include <span>
#include <string>

#include "harness/stability/trial.h"

namespace harness {

struct KnownDifference {
  const char* hard_case;  // its name
  const char* solver;
  Outcome fixed;    // at the case's own step
  Outcome outcome;  // with smaller steps, where that was refused
  const char* reason;
  const char* mends;  // what would make it the expected one
};

std::span<const KnownDifference> known_differences();
// Null if this is a new one.
const KnownDifference* known_difference(const std::string& hard_case, const std::string& solver,
                                        const TrialResult& result);

}  // namespace harness
