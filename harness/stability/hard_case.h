// The hard cases: small scenes in which solvers are known or expected to break, each with the
// outcome that theory or literature predicts for every solver.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/stability/trial.h"
#include "solvers/registry.h"

namespace harness {

// The solvers that an expectation is about: all, those that a predicate or the direction of their
// constraint forces selects, or those named: contestants, methods in all steppers, or "@bdf2", all
// methods in that stepper.
class Solvers {
 public:
  Solvers() = default;
  Solvers(inextensible::Direction direction);
  Solvers(std::function<bool(const inextensible::Backend&)> chosen) : chosen_(std::move(chosen)) {}
  Solvers(std::initializer_list<std::string> names) : names_(names) {}

  bool everyone() const { return !chosen_ && names_.empty(); }
  bool contains(const std::string& solver) const;
  const std::set<std::string>& names() const { return names_; }

 private:
  std::function<bool(const inextensible::Backend&)> chosen_;
  std::set<std::string> names_;
};

// The outcome that theory expects at the case's own, fixed step, and why. With smaller steps (after
// a refusal) solvers may survive, refuse or take too long, but nothing else.
struct Expectation {
  struct Other {
    Outcome outcome;
    std::string why;  // theory cannot decide: rounding, an iteration limit within the estimate, ...
  };
  Solvers solvers;
  Outcome outcome;
  std::string why;
  std::optional<Other> other = std::nullopt;

  Expectation or_else(Outcome admitted, std::string reason) && {
    other = {admitted, std::move(reason)};
    return std::move(*this);
  }
};

struct HardCase {
  std::string row;   // of the matrix, "Q1"; several cases may share one
  std::string name;  // unique, "Q1/exact"
  std::string what;  // one line
  std::function<Trial()> build;
  std::vector<Expectation> expectations;  // the last one is about everyone

  // The first expectation about the solver. A method that promises no limit need not notice that
  // no solution lies within it: where others refuse, it may survive.
  Expectation expectation(const std::string& solver) const;
};

// Values that families of cases run over, by name: distances (from the singular positions Q1 to
// Q4), limits (strain, of taut scenes), ratios (of masses), links (of long chains), sides (vertices
// along large cloths), scales (of far starts).
using HardCaseValues = std::map<std::string, std::vector<double>>;

// profile: quick, default or paper, which differ in how large chains and cloths grow.
HardCaseValues hard_case_values(const std::string& profile);
// values: all of the above. Throws UsageError, naming it, for a value that makes no scene.
std::vector<HardCase> hard_cases(const HardCaseValues& values);

// Outcomes of a solver that are known and are not what theory expects.
struct KnownDifference {
  struct Cause {
    const char *reason, *remedy;  // what would make the outcome the expected one
  };
  const char* solver;
  Outcome fixed;    // at the case's own step
  Outcome outcome;  // with smaller steps, where that was refused
  Cause cause;
  std::vector<std::string> hard_cases;  // their names
};

std::span<const KnownDifference> known_differences();
// Null if this is a new one.
const KnownDifference* known_difference(const std::string& hard_case, const std::string& solver,
                                        const TrialResult& result);

}  // namespace harness
