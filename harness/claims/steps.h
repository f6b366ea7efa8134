// Claims on what a step takes: matrices, sizes of steps, their cost.
#pragma once

#include "harness/claims/curves.h"

namespace harness::claims {

// As in contests.h.
void matrix_sizes(const Points& points, ClaimVerdict& claim);       // C11
void shake_small_steps(const Points& points, ClaimVerdict& claim);  // C15

}  // namespace harness::claims
