// The hard cases: small scenes in which solvers are known or expected to break, each with its
// expected outcome per solver, from theory or literature, written beside it.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/stability/trial.h"
#include "solvers/registry.h"

namespace harness {

// The solvers that an expectation speaks of: those whose constraint forces take their direction
// from the same place, those named, or all.
// names: of contestants, of methods in all steppers, or "@bdf2": all methods in that stepper.
class Solvers {
 public:
  Solvers() = default;
  Solvers(inextensible::Direction direction) : direction_(direction) {}
  Solvers(std::initializer_list<std::string> names) : names_(names) {}

  bool everyone() const { return !direction_ && names_.empty(); }
  bool contains(const std::string& solver) const;
  const std::set<std::string>& names() const { return names_; }

 private:
  std::optional<inextensible::Direction> direction_;
  std::set<std::string> names_;
};

// What solvers do in a case at its own, fixed step: the one outcome that theory expects, and why.
// The first expectation that names a solver counts. With smaller steps (after a refusal) solvers
// may survive, refuse or take too long, but nothing else.
struct Expectation {
  struct Other {
    Outcome outcome;
    std::string why;  // theory cannot decide: rounding, an iteration limit within the estimate, ...
  };
  Solvers solvers;
  Outcome outcome;
  std::string why;
  std::optional<Other> other = std::nullopt;
};

struct HardCase {
  std::string row;   // of the matrix, "Q1"; several cases may share one
  std::string name;  // unique, "Q1/exact"
  std::string what;  // one line
  std::function<Trial()> build;
  std::vector<Expectation> expectations;
};

// Values that families of cases run over, by name: distances (from the singular positions Q1 to
// Q4), limits (strain, of taut scenes), ratios (of masses), links (of long chains), sides (vertices
// along large cloths), scales (of far starts).
using HardCaseValues = std::map<std::string, std::vector<double>>;

// profile: quick, default or paper, which differ in how large chains and cloths grow.
HardCaseValues hard_case_values(const std::string& profile);
// values: all of the above. Throws UsageError, naming it, for a value that makes no scene.
std::vector<HardCase> hard_cases(const HardCaseValues& values);

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
