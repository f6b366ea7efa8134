// Claims on what works at all.
#pragma once

#include "harness/claims/curves.h"

namespace harness::claims {

// Each fills in the rule, the evidence, what was measured and the verdict; leaves the verdict alone
// where measurements are missing.
void springs_stiffness(const Points& points, ClaimVerdict& claim);        // C4
void failure_configurations(const Points& points, ClaimVerdict& claim);   // C9
void no_drift(const Points& points, ClaimVerdict& claim);                 // C10
void degrees_of_freedom_left(const Points& points, ClaimVerdict& claim);  // C14

}  // namespace harness::claims
