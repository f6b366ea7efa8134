// Claims on which method is fast, and how time grows.
#pragma once

#include "harness/claims/curves.h"

namespace harness::claims {

// Each fills in the rule, the evidence, what was measured and the verdict; leaves the verdict alone
// where measurements are missing.
void chain_time_over_strain(const Points& points, ClaimVerdict& claim);      // C1
void chain_time_over_resolution(const Points& points, ClaimVerdict& claim);  // C2
void chain_speed(const Points& points, ClaimVerdict& claim);                 // C3
void drape_time_over_strain(const Points& points, ClaimVerdict& claim);      // C5
void drape_time_over_resolution(const Points& points, ClaimVerdict& claim);  // C6

}  // namespace harness::claims
