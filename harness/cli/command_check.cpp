// bench check: whether a solver keeps what every solver must.
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/base/pattern.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/stability/conformance.h"
#include "solvers/registry.h"

namespace harness {
namespace {

void print(const Finding& finding) {
  const char* grade = finding.grade == Finding::Grade::pass   ? "PASS"
                      : finding.grade == Finding::Grade::fail ? "FAIL"
                                                              : "n/a ";
  std::cout << grade << "  " << std::left << std::setw(22) << finding.check << finding.measured
            << '\n';
  std::istringstream advice(finding.advice);
  for (std::string line; std::getline(advice, line);) std::cout << "      -> " << line << '\n';
  std::cout.flush();
}

bool check(const std::string& solver, bool hard_cases, std::int64_t seed) {
  const auto findings =
      examine(solver, {static_cast<std::uint64_t>(seed), hard_cases, print, interrupted});
  const auto count = [&](Finding::Grade grade) {
    return std::count_if(findings.begin(), findings.end(),
                         [grade](const Finding& f) { return f.grade == grade; });
  };
  std::cout << solver << (conforms(findings) ? " conforms: " : " does not conform: ")
            << count(Finding::Grade::pass) << " passed, " << count(Finding::Grade::fail)
            << " failed, " << count(Finding::Grade::not_applicable) << " not applicable"
            << std::endl;
  return conforms(findings);
}

int check_all(const std::string& solver, bool hard_cases, std::int64_t seed) {
  check_solver_pattern(solver);
  catch_interrupts();
  const Pattern wanted("--solver", solver);
  bool conform = true;
  for (const auto& backend : inextensible::backends()) {
    if (wanted.matches(backend.name)) conform = check(backend.name, hard_cases, seed) && conform;
  }
  return conform ? success : unexpected_outcome;
}

}  // namespace

Verb check_verb() {
  return {"check", "test what every solver must fulfil, and say where to look if one does not",
          [](const Command& command) -> Action {
            struct Given {
              std::string solver;
              bool quick = false;
              std::int64_t seed = 1;
            };
            const auto given = std::make_shared<Given>();
            add_solver(command, given->solver).required();
            command.flag("--quick", given->quick, "without the hard cases, which may take minutes");
            command.option("--seed", given->seed, "of methods that draw random numbers", "N")
                .holds(Bounds::exact_number());
            return [given] { return check_all(given->solver, !given->quick, given->seed); };
          }};
}

}  // namespace harness
