// Schemas of files: definitions that follow from tables of fields are generated, the rest is
// written by hand.
#pragma once

#include "harness/points/contestant.h"

namespace harness {

// What one solver made of a known answer at one step: a row of a result file of schema
// inextensible-answers/1.
struct AnswerRow {
  std::string answer, solver;
  double step = 0;         // s
  double value = unknown;  // what was read off; unknown where the run ended early
  double deviation = unknown, order = unknown;
  std::string detail;  // why there is no value; empty: there is one
};

inline constexpr std::tuple answer_row_fields{
    field("answer", &AnswerRow::answer, "", "its name"),
    field("solver", &AnswerRow::solver, "", "its name; at its default settings"),
    field("step", &AnswerRow::step, "s", "", {.positive = true}),
    field("value", &AnswerRow::value, "", "what was read off the run", {.nullable = true}),
    field("deviation", &AnswerRow::deviation, "", "from the exact value, over it unless it is 0",
          {.nullable = true}),
    field("order", &AnswerRow::order, "",
          "of accuracy, from the deviations at this step and at the one twice as large",
          {.nullable = true}),
    field("detail", &AnswerRow::detail, "", "why there is no value", {.nullable = true})};

// The text for configs/<name>.schema.json: the definitions that follow from tables,
// "status", "counter", "work", "point" and "answer_row", are replaced. "result", "baseline",
// "gate", "stability", "tuned", "answers".
std::string schema_text(const std::string& name);
std::vector<std::string> generated_schemas();

// Names and meanings that figures show: of all registered solvers, each followed by contestants
// that are it under another name, and of statuses.
nlohmann::ordered_json legend(const Contestants& contestants = {});

// Schema of `work` in a result file.
std::vector<std::string> counter_names();

// Throws UsageError, naming `path` and the first place that does not fit, unless `document` is as
// configs/<schema>.schema.json says.
void check_schema(const json& document, const std::string& schema, const std::string& path);

}  // namespace harness
