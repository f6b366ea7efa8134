// The program's verbs, in the order of its help.
#pragma once

#include <vector>

#include "harness/cli/command_line.h"

namespace harness {

// To add one: a file with NAME_verb(), and a line here.
#define HARNESS_VERBS(VERB) \
  VERB(sweep)               \
  VERB(show)                \
  VERB(plot)                \
  VERB(report)              \
  VERB(answers)             \
  VERB(film)                \
  VERB(choose)              \
  VERB(check)               \
  VERB(budget)              \
  VERB(claims)              \
  VERB(results)             \
  VERB(compare)             \
  VERB(baseline)            \
  VERB(ab)                  \
  VERB(tune)                \
  VERB(reference)           \
  VERB(point)               \
  VERB(list)

#define HARNESS_DECLARE(name) Verb name##_verb();
HARNESS_VERBS(HARNESS_DECLARE)
#undef HARNESS_DECLARE

// The first one is what the program does without a verb.
inline std::vector<Verb> verbs() {
#define HARNESS_ROW(name) name##_verb(),
  return {HARNESS_VERBS(HARNESS_ROW)};
#undef HARNESS_ROW
}

}  // namespace harness
