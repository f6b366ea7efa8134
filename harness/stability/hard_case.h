// The hard cases: small scenes in which solvers are known or expected to break, each with its
// expected outcome per solver, from theory or literature, written beside it.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/stability/trial.h"

namespace harness {

// What solvers do in a case at its own, fixed step. The first expectation that names a solver
// counts. With smaller steps (after a refusal) solvers may survive, refuse or take too long;
// `diverged` and `wrong` only where an expectation allows them.
struct Expectation {
  std::set<std::string> solvers;  // empty: all
  std::set<Outcome> allowed;
  std::string why;
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

}  // namespace harness
