// The matrix of hard cases: bench --sweep stability.
#include <iostream>
#include <sstream>

#include "harness/base/shard.h"
#include "harness/base/standard_streams.h"
#include "harness/cli/sweep_run.h"
#include "harness/points/context.h"
#include "harness/stability/stability.h"

namespace harness {
namespace {

// "ratios=1e3,1e5" into `values`.
void set_values(HardCaseValues& values, const std::string& given) {
  const auto [name, list] = name_and_value(given);
  std::vector<std::string> names;
  for (const auto& entry : values) names.push_back(entry.first);
  check_known("value of hard cases", name, names);
  values[name] = numbers_of("--values " + name, list, {});
}

// cases must outlive it.
StabilityPlan plan_of(const SweepCommand& options, const std::vector<HardCase>& cases) {
  StabilityFilters filters;
  filters.solver = solver_pattern(options.solver);
  filters.hard_case = pattern_of("--case", options.hard_case);
  StabilityPlan plan = plan_stability(cases, filters);
  if (!options.shard.empty()) plan.keep(parse_shard(options.shard));
  return plan;
}

int print_plan(const StabilityPlan& plan) {
  std::cout << plan.cells() << " cells: " << plan.cases.size() << " hard cases by "
            << plan.solvers.size() << " solvers; " << plan.scenes.size()
            << " scenes for each solver's largest step, " << plan.frames.size()
            << " for frames side by side\n";
  return success;
}

void add_cells_of(const nlohmann::json& result, Journal& journal) {
  for (const nlohmann::json& row : result.at("matrix"))
    journal.add(cell_key(row.at("case"), row.at("solver")), to_json(trial_result_of(row)));
}

}  // namespace

int run_hard_cases(const SweepCommand& options, const Words& typed) {
  check_known("profile", options.profile, profiles());
  HardCaseValues values = hard_case_values(options.profile);
  for (const std::string& given : options.values) set_values(values, given);
  const std::vector<HardCase> cases = hard_cases(values);
  const StabilityPlan plan = plan_of(options, cases);
  if (options.dry_run) return print_plan(plan);
  nlohmann::json context = machine_context();
  context["selection"] = {{"solver", options.solver},
                          {"case", options.hard_case},
                          {"values", values},
                          {"seed", options.seed},
                          {"shard", options.shard}};
  const auto run = [&](const std::string&, Journal& journal, const nlohmann::json&) -> Finished {
    Progress progress;
    const std::uint64_t seed = options.seed < 0 ? 1 : static_cast<std::uint64_t>(options.seed);
    const StabilityOutcome outcome = run_stability(plan, seed, journaled_events(journal, progress));
    std::ostringstream text;
    print_stability(text, outcome, output_columns());
    return {stability_document(context, outcome, seed, typed), outcome.complete, text.str(),
            outcome.nothing_new() ? success : unexpected_outcome};
  };
  return carry_out(options,
                   {options.profile + "-stability", identity(context, {}, context["selection"]),
                    context, "matrix", "cells", run, add_cells_of});
}

}  // namespace harness
