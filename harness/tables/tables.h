// What result files say, as tables on a terminal and on a page of Markdown (docs/results.md).
#pragma once

#include "harness/analysis/plane.h"
#include "harness/base/table.h"
#include "harness/points/result_file.h"

namespace harness {

// For each scene and size the answers of the strain-error grid (levels of error with the same
// answer share a line), findings, and the growth of a step's time with resolution; then the noise.
// all: also every contestant, fastest first, and how failed runs ended. file: its name in hints.
void print_sweep(std::ostream& out, const json& document, const std::string& file,
                 bool all = false);
// How each solver's hard cases ended, the unexpected outcomes, and the largest stable steps.
void print_outcomes(std::ostream& out, const json& document);

// docs/results.md. results: sweeps and stability sweeps, which decide the claims. answers: results
// of `bench answers`. Throws UsageError for incomplete documents.
void print_results_page(std::ostream& out, const std::vector<NamedResult>& results,
                        const std::vector<NamedResult>& answers = {});

// Hard cases: counts of outcomes by solver; and unexpected outcomes with their reasons if known.
Table outcomes_in(const json& document);
Table differences_in(const json& document);

}  // namespace harness
