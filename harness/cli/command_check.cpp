// bench check: whether a solver keeps what every solver must.
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/cli/commands.h"
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

int check(const std::string& solver, bool hard_cases, std::int64_t seed) {
  if (!inextensible::find_backend(solver)) {
    std::vector<std::string> names;
    for (const auto& backend : inextensible::backends()) names.emplace_back(backend.name);
    throw unknown_name("solver", solver, names);
  }
  catch_interrupts();
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
  return conforms(findings) ? success : unexpected_outcome;
}

}  // namespace

void add_check_command(const Command& program) {
  struct Given {
    std::string solver;
    bool quick = false;
    std::int64_t seed = 1;
  };
  const auto given = std::make_shared<Given>();
  const Command command = program.subcommand(
      "check", "whether a solver keeps what every solver must, and where to look if not");
  command.option("--solver", given->solver, "its name", "NAME").required();
  command.flag("--quick", given->quick, "without the hard cases, which may take minutes");
  command.option("--seed", given->seed, "of methods that draw random numbers", "N").not_negative();
  command.does([given] { return check(given->solver, !given->quick, given->seed); });
}

}  // namespace harness
