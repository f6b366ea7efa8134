// The checks of `bench check`, and what they share: the solver under examination and the cases it
// is put through.
#pragma once

#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/scenes/scene.h"
#include "harness/stability/conformance.h"
#include "solvers/registry.h"

namespace harness {

// Some steps of one scene.
struct Case {
  std::string name;
  Scene scene;
  double step;  // s
  int steps;
  double limit;  // strain
};
Case scene_case(const std::string& name, const char* type, const SceneParameters& given,
                double step, int steps);
// A crumpled net of n x n vertices about 1 m apart, masses over a decade, weightless; the first
// `pins` are pinned; speeds up to `speed` m/s in each coordinate.
Case net(std::uint64_t seed, int n, int pins, double speed, double step, int steps, double limit);

// The solver does not take the scene, and says why.
struct NotTaken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Examinee {
  const inextensible::Backend& backend;
  const ConformanceOptions& options;

  bool keeps_a_limit() const {
    return backend.strain_control == inextensible::StrainControl::strain_limit;
  }
  // Throws NotTaken.
  std::unique_ptr<inextensible::Stepper> stepper(const Case& c,
                                                 const inextensible::Settings& settings = {}) const;
  // Makes a drape of n x n without the parts that the solver does not take.
  SceneParameters drape(int n) const;
};

// What a check says; `advice` is kept for a failure only.
Finding judged(bool passed, const std::string& check, const std::string& measured,
               const std::string& advice);
Finding not_applicable(const std::string& check, const std::string& why);

bool same_bits(const inextensible::Positions& a, const inextensible::Positions& b);
bool same_bits(const inextensible::State& a, const inextensible::State& b);

// All parts in a row, numbers with three digits.
template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  stream.precision(3);
  (stream << ... << parts);
  return stream.str();
}

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
