// What one solver made of a known answer at one step: a row of a result file of schema
// inextensible-answers/1.
#pragma once

#include <string>
#include <tuple>

#include "harness/base/fields.h"
#include "harness/points/measures.h"

namespace harness {

struct AnswerRow {
  std::string answer, solver;
  double step = 0;         // s
  double value = unknown;  // what was read off; unknown where the run ended early
  double deviation = unknown;
  double order = unknown;
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

}  // namespace harness
