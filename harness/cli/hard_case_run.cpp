// The matrix of hard cases: bench --sweep stability.
#include <iostream>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/base/shard.h"
#include "harness/base/standard_streams.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/figures.h"
#include "harness/cli/sweep_run.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"
#include "harness/stability/stability.h"

namespace harness {
namespace {

// "ratios=1e3,1e5" into `values`.
void set_values(HardCaseValues& values, const std::string& given) {
  const auto equals = given.find('=');
  const std::string name = given.substr(0, equals);
  const auto place = values.find(name);
  if (place == values.end()) {
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    throw unknown_name("value of hard cases", name, names);
  }
  place->second.clear();
  std::istringstream list(equals == std::string::npos ? "" : given.substr(equals + 1));
  for (std::string item; std::getline(list, item, ',');) {
    std::size_t read = 0;
    try {
      place->second.push_back(std::stod(item, &read));
    } catch (const std::exception&) {
      read = 0;
    }
    if (read == 0 || read != item.size())
      throw UsageError("--values " + given + ": '" + item + "' is not a number");
  }
  if (place->second.empty())
    throw UsageError("--values " + given + ": must be NAME=NUMBER,NUMBER,...");
}

// cases must outlive it.
StabilityPlan plan_of(const SweepCommand& options, const std::vector<HardCase>& cases) {
  StabilityFilters filters;
  if (!options.solver.empty()) {
    check_solver_pattern(options.solver);
    filters.solver = Pattern("--solver", options.solver);
  }
  if (!options.hard_case.empty()) filters.hard_case = Pattern("--case", options.hard_case);
  StabilityPlan plan = plan_stability(cases, filters);
  if (!options.shard.empty()) plan.keep(parse_shard(options.shard));
  return plan;
}

void tell_plan(const StabilityPlan& plan) {
  std::cout << plan.cells() << " cells: " << plan.cases.size() << " hard cases by "
            << plan.solvers.size() << " solvers; " << plan.scenes.size()
            << " scenes for each solver's largest step, " << plan.frames.size()
            << " for frames side by side\n";
}

void add_cells_of(const nlohmann::json& result, Journal& journal) {
  for (const nlohmann::json& row : result.at("matrix"))
    journal.add(cell_key(row.at("case"), row.at("solver")), to_json(trial_result_of(row)));
}

}  // namespace

int run_hard_cases(const SweepCommand& options, const std::vector<std::string>& command) {
  check_profile(options.profile);
  HardCaseValues values = hard_case_values(options.profile);
  for (const std::string& given : options.values) set_values(values, given);
  const std::vector<HardCase> cases = hard_cases(values);
  const StabilityPlan plan = plan_of(options, cases);
  if (options.dry_run) {
    tell_plan(plan);
    return success;
  }
  const std::string out = chosen_output(options, options.profile + "-stability");
  check_writable(out);
  nlohmann::json context = machine_context();
  context["selection"] = {{"solver", options.solver},
                          {"case", options.hard_case},
                          {"values", values},
                          {"seed", options.seed},
                          {"shard", options.shard}};
  Journal journal(out);
  if (begin_journal(options, out, journal,
                    {identity(context, {}, context["selection"]), context, "matrix", "cells",
                     [](const Journal& j) { return j.known().size(); }, add_cells_of})
          .finished) {
    std::cout << out << " is complete already\n";
    return success;
  }
  catch_interrupts();
  const std::uint64_t seed = options.seed < 0 ? 1 : static_cast<std::uint64_t>(options.seed);
  const StabilityOutcome outcome = run_stability(plan, seed, journaled_events(journal));
  write_atomically(out, result_text(stability_document(context, outcome, seed, command)));
  print_stability(std::cout, outcome, output_columns());
  std::cout << "\nwritten:\n" << out << std::endl;
  if (!outcome.complete) return tell_interrupted();
  journal.remove();
  if (!options.no_plots && draw_result(out) != 0)
    std::cerr << "bench: the figure could not be drawn\n";
  return outcome.nothing_new() ? success : unexpected_outcome;
}

}  // namespace harness
