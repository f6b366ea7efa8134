#include "harness/stability/hard_case.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/text.h"

namespace harness {
namespace {

constexpr void (*families[])(std::vector<HardCase>&, const HardCaseValues&) = {
    add_failure_configurations,
    add_taut,
    add_degenerate,
    add_mass_ratios,
    add_whip,
    add_large,
    add_contact,
    add_far_starts,
    add_impossible_numbers,
};

// Throws UsageError for a value that makes no scene.
void check_values(const HardCaseValues& values) {
  for (const auto& [name, list] : values) {
    const bool size = name == "links" || name == "sides";
    for (const double value : list) {
      const bool possible = size ? value >= 2 && value <= 1e7 && value == std::floor(value)
                                 : value > 0 && std::isfinite(value) &&
                                       (name != "distances" || value < 1) &&
                                       (name != "limits" || value < 1);
      if (!possible)
        throw UsageError("hard cases: '" + name + "' has " + number_text(value) + ", must be " +
                         (size                                      ? "a whole number from 2 on"
                          : name == "distances" || name == "limits" ? "above 0 and below 1"
                                                                    : "above 0"));
    }
  }
}

// A method that promises no limit need not notice that there is no solution within it.
void admit_who_promises_nothing(HardCase& hard_case) {
  for (const auto& backend : inextensible::backends()) {
    if (backend.strain_control != inextensible::StrainControl::time_step) continue;
    const auto expected =
        std::find_if(hard_case.expectations.begin(), hard_case.expectations.end(),
                     [&](const Expectation& e) { return e.solvers.contains(backend.name); });
    if (expected == hard_case.expectations.end() || expected->outcome != Outcome::refused ||
        expected->other)
      continue;
    Expectation own{Solvers{{backend.name}}, expected->outcome, expected->why};
    own.other = {Outcome::survived, "no limit is promised, so that it need not be noticed"};
    hard_case.expectations.insert(hard_case.expectations.begin(), std::move(own));
  }
}

}  // namespace

bool Solvers::contains(const std::string& solver) const {
  if (everyone() || names_.contains(solver)) return true;
  const auto* backend = inextensible::find_backend(solver);
  if (!backend) return false;
  if (direction_) return backend->direction == *direction_;
  return names_.contains(backend->method) || names_.contains(std::string("@") + backend->stepper);
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
  check_values(values);
  std::vector<HardCase> cases;
  for (const auto add : families) add(cases, values);
  for (HardCase& hard_case : cases) admit_who_promises_nothing(hard_case);
  return cases;
}

}  // namespace harness
