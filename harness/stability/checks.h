// The checks of `bench check`, in files check_....
#pragma once

#include <vector>

#include "harness/stability/examinee.h"

namespace harness {

using Findings = std::vector<Finding>;

// Pins, limit and counters of ordinary scenes at ordinary steps.
Findings check_ordinary_runs(const Examinee& solver);
// Linear and angular momentum of a free, weightless net.
Findings check_momentum(const Examinee& solver);
// Steps that no method can take.
Findings check_refusal(const Examinee& solver);
// A candidate that keeps the limit already.
Findings check_permissible_candidate(const Examinee& solver);
// The same bits beside another instance.
Findings check_determinism(const Examinee& solver);
// Smaller steps, smaller error, towards the right motion.
Findings check_consistency(const Examinee& solver);
// Every hard case of the profile "quick".
Findings check_hard_cases(const Examinee& solver);

}  // namespace harness
