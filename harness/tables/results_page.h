// What result files say, as a page of Markdown tables (docs/results.md).
#pragma once

#include <ostream>
#include <vector>

#include "harness/analysis/budget.h"
#include "harness/points/result_file.h"

namespace harness {

// results: of sweeps and stability sweeps; the claims are decided by these. growth: only for tables
// of growth, so that a sweep at a fixed step does not take part in contests of best steps. answers:
// of `bench answers`.
// Throws UsageError for documents that lack something.
void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& growth,
                        const std::vector<NamedResult>& answers = {});

// The tables of analysis/budget.h, in Markdown.
void print_budgets(std::ostream& out, const std::vector<analysis::BudgetTable>& tables);

}  // namespace harness
