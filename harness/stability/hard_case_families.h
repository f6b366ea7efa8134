// The families of hard cases. Each function appends its cases, one for each value of the lists that
// it runs over; it stands in a file cases_... of its own.
#pragma once

#include "harness/stability/hard_case.h"

namespace harness {

void add_failure_configurations(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_taut(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_degenerate(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_mass_ratios(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_whip(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_large(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_contact(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_far_starts(std::vector<HardCase>& cases, const HardCaseValues& values);
void add_impossible_numbers(std::vector<HardCase>& cases, const HardCaseValues& values);

}  // namespace harness
