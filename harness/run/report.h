// What a person sees at the end of a sweep: tables, and who is fastest.
#pragma once

#include <ostream>
#include <vector>

#include "harness/run/sweep.h"

namespace harness {

// Per scene and sweep: solvers by limit or resolution, best seconds per simulated second whatever
// the motion, its step and its error; of a step sweep, the time to reach each of some errors;
// failures by name. What counts within errors: plane_table.h.
// At most 120 columns wide. Who is fastest: plane_table.h.
void print_table(std::ostream& out, const std::vector<PointResult>& points);

}  // namespace harness
