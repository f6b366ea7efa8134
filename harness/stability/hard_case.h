// The hard cases: small scenes in which solvers are known or expected to break, each with the
// outcome that theory or literature predicts for every solver.
#pragma once

#include "harness/stability/trial.h"

namespace harness {

// The outcome that theory expects at the case's own, fixed step, and why. With smaller steps (after
// a refusal) solvers may survive, refuse or take too long, but nothing else.
struct Expectation {
  struct Other {
    Outcome outcome;
    std::string why;  // theory cannot decide: rounding, an iteration limit within the estimate, ...
  };
  std::vector<std::string> solvers;  // words of configs/hard_cases.json; none: all solvers
  Outcome outcome = Outcome::survived;
  std::string why;
  std::optional<Other> other = std::nullopt;

  bool about(const Backend& backend) const;
};

struct HardCase {
  std::string row;   // of the matrix, "Q1"; several cases may share one
  std::string name;  // unique, "Q1/0.01"
  std::string what;  // one line
  std::function<Trial()> build;
  double value = unknown;                      // of a series of cases
  std::vector<Expectation> expectations = {};  // the last one is about all methods

  // The first expectation about the solver. A method that promises no strain limit need not notice
  // that no solution satisfies it: where others refuse, it may survive.
  Expectation expectation(const std::string& solver) const;
};

std::vector<HardCase> hard_cases(const std::string& profile);
// The values that its series of cases run over, by the name of their list.
std::map<std::string, std::vector<double>> hard_case_values(const std::string& profile);
// Adds the expectations of configs/hard_cases.json that apply to each case.
void add_expectations(std::vector<HardCase>& cases);
// configs/hard_cases.json. Throws UsageError where it violates its schema.
const json& hard_cases_document();

// Outcomes of a solver that are known and are not what theory expects.
struct KnownDifference {
  std::string solver;
  Outcome fixed;                        // at the case's own step
  Outcome outcome;                      // with smaller steps, where that was refused
  std::string reason, remedy;           // what would make the outcome the expected one
  std::vector<std::string> hard_cases;  // their names
};

const std::vector<KnownDifference>& known_differences();
// Null for a difference that is not listed.
const KnownDifference* known_difference(const std::string& hard_case, const std::string& solver,
                                        const TrialResult& result);

}  // namespace harness
