// bench check: tests what every solver must fulfil. bench answers: solvers against exact solutions.
#include <iomanip>

#include "harness/answers/answer.h"
#include "harness/cli/command.h"
#include "harness/points/context.h"
#include "harness/stability/conformance.h"

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

struct Check {
  std::string solver;
  bool quick = false;
  std::int64_t seed = 1;

  void declare(const Command& command) {
    add_solver(command, solver);
    command.require({"--solver"});
    command.flag("--quick", quick, "without the hard cases, which may take minutes");
    command.option("--seed", seed, "of methods that draw random numbers", "N",
                   Bounds::exact_number());
  }

  bool conforms_to_all(const std::string& name) const {
    const auto findings =
        examine(name, {static_cast<std::uint64_t>(seed), !quick, print, interrupted});
    const auto count = [&findings](Finding::Grade grade) {
      return std::ranges::count(findings, grade, &Finding::grade);
    };
    // One that takes none of the scenes has shown nothing.
    const bool conforms = count(Finding::Grade::fail) == 0 && count(Finding::Grade::pass) > 0;
    std::cout << name << (conforms ? " conforms: " : " does not conform: ")
              << count(Finding::Grade::pass) << " passed, " << count(Finding::Grade::fail)
              << " failed, " << count(Finding::Grade::not_applicable) << " not applicable"
              << std::endl;
    return conforms;
  }

  int run() const {
    const auto wanted = solver_pattern(solver);
    bool conform = true;
    for (const auto& backend : backends())
      if (wanted->matches(backend.name)) conform = conforms_to_all(backend.name) && conform;
    return conform ? success : unexpected_outcome;
  }
};

struct Answers : OutputOptions {
  std::string solver, answer;
  double timeout = 20;

  void declare(const Command& command) {
    add_solver(command, solver);
    command.alternatives("--answer", answer,
                         "only answers whose whole name matches (bench list answers)");
    add_timeout(command, timeout, "20");
    OutputOptions::declare(command, "answers.json");
  }

  int run(const Words& typed) {
    const auto plan = plan_answers(pattern_of("--answer", answer), solver_pattern(solver));
    json context = machine_context();
    context["selection"] = {{"solver", solver}, {"answer", answer}, {"timeout", timeout}};
    const auto compute = [&](Journal& journal, const json&) -> Finished {
      Progress progress;
      const AnswerOutcome outcome = run_answers(plan, timeout, journaled_events(journal, progress));
      if (!outcome.complete) return {.complete = false};
      return {answers_document(context, plan, outcome, typed)};
    };
    return carry_out(*this, {"answers", context, {}, "rows", "runs", compute});
  }
};

}  // namespace

Action check_verb(const Command& command) { return verb<Check>(command); }
Action answers_verb(const Command& command) { return verb<Answers>(command); }

}  // namespace harness
