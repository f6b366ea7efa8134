// What Figure 1 shows: how far a patch of cloth sags between its pins.
#pragma once

#include "harness/claims/curves.h"

namespace harness::claims {

// Fills in the rule, the evidence, what was measured and the verdict; leaves the verdict alone
// where measurements are missing.
void patch_sag(const Points& points, ClaimVerdict& claim);  // C12

// The sag of a yarn under a load that is even along the line between its ends, which are `length`
// (m) apart: a parabola whose arc is longer than that by `strain`.
double parabola_sag(double length, double strain);

}  // namespace harness::claims
