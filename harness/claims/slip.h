// What Figure 7 shows: whether a garment slips past the hips that are to hold it.
#pragma once

#include "harness/claims/curves.h"

namespace harness::claims {

// How far a point's rim is below the waist where it began, over the way from
// there to the hips; of the end that is higher and of the one that is lower.
struct Slip {
  double least, most;
  bool held() const { return most < 1; }
  bool past() const { return least > 1; }
};
Slip slip_of(const Point& point);

// Fills in the rule, the evidence, what was measured and the verdict; leaves the verdict alone
// where measurements are missing.
void garment_slip(const Points& points, ClaimVerdict& claim);  // C16

}  // namespace harness::claims
