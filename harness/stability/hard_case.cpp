#include "harness/stability/hard_case.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/stability/cases.h"

namespace harness {
namespace {

constexpr void (*families[])(cases::Cases&) = {
    cases::add_failure_configurations,
    cases::add_taut,
    cases::add_degenerate,
    cases::add_mass_ratios,
    cases::add_whip,
    cases::add_large,
    cases::add_contact,
    cases::add_far_starts,
    cases::add_impossible_numbers,
};

void check_value(const std::string& name, double value) {
  const bool size = name == "links" || name == "sides",
             fraction = name == "distances" || name == "limits";
  const bool possible = size ? value >= 2 && value <= 1e7 && value == std::floor(value)
                             : value > 0 && value < (fraction ? 1.0 : HUGE_VAL);
  if (!possible)
    throw UsageError("hard cases: '" + name + "' has " + number_text(value) + ", must be " +
                     (size       ? "a whole number from 2 on"
                      : fraction ? "above 0 and below 1"
                                 : "above 0"));
}

}  // namespace

Solvers::Solvers(inextensible::Direction direction)
    : chosen_([direction](const auto& backend) { return backend.direction == direction; }) {}

bool Solvers::contains(const std::string& solver) const {
  if (everyone() || names_.contains(solver)) return true;
  const auto* backend = inextensible::find_backend(solver);
  if (!backend) return false;
  if (chosen_) return chosen_(*backend);
  return names_.contains(backend->method) || names_.contains(std::string("@") + backend->stepper);
}

Expectation HardCase::expectation(const std::string& solver) const {
  Expectation expected =
      *std::find_if(expectations.begin(), expectations.end(),
                    [&](const Expectation& e) { return e.solvers.contains(solver); });
  const auto* backend = inextensible::find_backend(solver);
  if (backend && backend->strain_control == inextensible::StrainControl::time_step &&
      expected.outcome == Outcome::refused && !expected.other)
    expected.other = {Outcome::survived, "no limit is promised, so that it need not be noticed"};
  return expected;
}

HardCaseValues hard_case_values(const std::string& profile) {
  HardCaseValues values{{"distances", {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}},
                        {"limits", {0.01, 0.001}},
                        {"ratios", {1e2, 1e4, 1e6, 1e8}},
                        {"links", {10, 100, 1000}},
                        {"sides", {21}},
                        {"scales", {1.5, 0.5}}};
  if (profile != "quick") {
    values["links"] = {10, 100, 1000, 10000, 100000};
    values["sides"] = {21, 51};
  }
  if (profile == "paper") values["sides"] = {21, 51, 101, 201};
  return values;
}

std::vector<HardCase> hard_cases(const HardCaseValues& values) {
  for (const auto& [name, list] : values) {
    for (const double value : list) check_value(name, value);
  }
  cases::Cases cases{values};
  for (const auto add : families) add(cases);
  return std::move(cases.list);
}

}  // namespace harness
