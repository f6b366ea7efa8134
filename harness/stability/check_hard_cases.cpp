
#include "harness/stability/checks.h"
#include "harness/stability/stability.h"

namespace harness {

Findings check_hard_cases(const Examinee& solver) {
  const char* check = "hard cases";
  if (!solver.options.hard_cases) return {not_applicable(check, "left out")};
  if (!solver.backend.contestant) return {not_applicable(check, "for contestants only")};
  const auto cases = harness::hard_cases(hard_case_values("quick"));
  StabilityFilters filters;
  filters.solver = Pattern("solver", solver.backend.name);
  filters.but_case = Pattern("case", "^(largest step|same frame)");
  const StabilityOutcome outcome =
      run_stability(plan_stability(cases, filters), solver.options.seed, {});
  int survived = 0, refused = 0, slow = 0, known = 0, unexpected = 0;
  std::string advice;
  for (const StabilityCell& cell : outcome.cells) {
    const Outcome o = cell.result.outcome;
    survived += o == Outcome::survived || o == Outcome::survived_smaller;
    refused += o == Outcome::refused;
    slow += o == Outcome::timeout;
    known += cell.known ? 1 : 0;
    if (cell.expected || cell.known) continue;
    ++unexpected;
    advice += text(advice.empty() ? "" : "\n", cell.hard_case->name, " (", cell.hard_case->what,
                   "): ", to_string(cell.result.fixed), ", ", cell.result.detail);
  }
  return {
      judged(unexpected == 0, check,
             text(outcome.cells.size(), " cases: ", survived, " survived, ", refused, " refused, ",
                  slow, " too slow; ", unexpected, " ended as they should not (allowed 0)",
                  known == 0 ? "" : text(", besides ", known, " known ones")),
             advice)};
}

}  // namespace harness
