#include "harness/stability/conformance.h"

#include <algorithm>

#include "harness/stability/checks.h"

namespace harness {
namespace {

constexpr Findings (*checks[])(const Examinee&) = {
    check_ordinary_runs, check_momentum,    check_refusal,     check_permissible_candidate,
    check_determinism,   check_consistency, check_allocations, check_hard_cases,
};

}  // namespace

std::vector<Finding> examine(const std::string& solver, const ConformanceOptions& options) {
  const Examinee examinee{*inextensible::find_backend(solver), options};
  std::vector<Finding> findings;
  for (const auto check : checks) {
    for (const Finding& finding : check(examinee)) {
      findings.push_back(finding);
      options.finding(finding);
    }
  }
  return findings;
}

Findings check_allocations(const Examinee& /*solver*/) {
  return {
      not_applicable("allocations",
                     "not counted here; tests/solvers/methods/no_allocation_test.cpp shows how: "
                     "none in a step after the first")};
}

bool conforms(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.grade == Finding::Grade::fail; });
}

}  // namespace harness
