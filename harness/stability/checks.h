// The checks of `bench check`.
#pragma once

#include <span>
#include <stdexcept>
#include <vector>

#include "harness/stability/conformance.h"
#include "solvers/registry.h"

namespace harness {

using Findings = std::vector<Finding>;

struct Examinee {
  const inextensible::Backend& backend;
  const ConformanceOptions& options;
};

// The solver does not take the scene, and says why.
struct NotTaken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Check {
  const char* name;
  Findings (*run)(const Examinee&);  // throws NotTaken
  double timeout = 120;              // s
};
std::span<const Check> checks();

}  // namespace harness
