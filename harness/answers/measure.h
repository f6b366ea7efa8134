// Runs solvers against known answers.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "harness/answers/answer.h"
#include "harness/base/pattern.h"
#include "harness/base/small_runs.h"
#include "harness/points/answer_row.h"

namespace harness {

struct AnswerSelection {
  std::optional<Pattern> answer, solver;  // must match the whole name
  double timeout = 20;                    // s of wall time, of each run
};

// A solver's runs at all steps of an answer, each in a child process, the coarsest step first.
struct AnswerRun {
  const KnownAnswer* answer;
  std::string solver;
};
// All contestants that can do the answer's scene. Throws UsageError if nothing matches.
std::vector<AnswerRun> plan_answers(const AnswerSelection& selection);

struct AnswerOutcome {
  std::vector<AnswerRow> rows;
  bool complete = true;  // false: interrupted
};
AnswerOutcome run_answers(const std::vector<AnswerRun>& plan, double timeout,
                          const RunEvents& events);

nlohmann::json answers_document(nlohmann::json context, const std::vector<AnswerRun>& plan,
                                const AnswerOutcome& outcome,
                                const std::vector<std::string>& command);
// Prints such a document.
void print_answers(std::ostream& out, const nlohmann::json& document);

}  // namespace harness
