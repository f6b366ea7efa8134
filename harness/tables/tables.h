// What result files say, as tables on a terminal and on a page of Markdown (docs/results.md).
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "harness/analysis/plane.h"
#include "harness/base/table.h"
#include "harness/points/result_file.h"

namespace harness {

// ---- On a terminal ----

// A sweep's result. For each scene and size a line for each answer of the
// strain-error grid, levels of error with the same answer in one; its findings
// (analysis/findings.h), of resolution sweeps the growth of a step's time; how much of that is
// noise. all: every contestant too, fastest first, and how the runs that failed ended. file: what
// the document is called in hints.
void print_sweep(std::ostream& out, const nlohmann::json& document, const std::string& file,
                 bool all = false);
// How each solver's hard cases ended, which did not end as expected, and its largest stable steps.
void print_outcomes(std::ostream& out, const nlohmann::json& document);

// ---- In Markdown ----

// results: of sweeps and stability sweeps; the claims are decided by these. growth: only for tables
// of growth, so that a sweep at a fixed step does not take part in contests of best steps. answers:
// of `bench answers`.
// Throws UsageError for documents that lack something.
void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& growth,
                        const std::vector<NamedResult>& answers = {});
void print_budgets(std::ostream& out, const std::vector<analysis::BudgetTable>& tables);

// ---- What both have in common ----

// Hard cases: how many of each solver's ended in which way; and what did not end as theory
// expects, with the reason where one is known.
Table outcomes_in(const nlohmann::json& document);
Table differences_in(const nlohmann::json& document);

}  // namespace harness
