// Claims on what is computed: residuals, shapes, strains.
#pragma once

#include "harness/claims/curves.h"

namespace harness::claims {

// Each fills in the rule, the evidence, what was measured and the verdict; leaves the verdict alone
// where measurements are missing.
void residual_order(const Points& points, ClaimVerdict& claim);          // C7
void same_frame(const Points& points, ClaimVerdict& claim);              // C8
void strain_after_collision(const Points& points, ClaimVerdict& claim);  // C13

}  // namespace harness::claims
