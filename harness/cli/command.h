// The program's verbs, in the order of its help, and what their files have in common.
#pragma once

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/json.h"
#include "harness/base/text.h"
#include "harness/cli/options.h"
#include "harness/cli/output.h"

namespace harness {

// VERB(name, children, summary): a file of this folder has NAME_verb(). A verb with children
// computes in them, and answers an interruption with what was done until then. The first one is
// what the program does without a verb.
#define HARNESS_VERBS(VERB)                                                                       \
  VERB(sweep, true,                                                                               \
       "time over strain limit, resolution or step, or hard cases: bench --sweep AXIS")           \
  VERB(show, false,                                                                               \
       "print a result file: which method is fastest within each strain limit and error")         \
  VERB(plot, false,                                                                               \
       "draw the figures of a result file again; of several pieces of one sweep as one")          \
  VERB(report, false,                                                                             \
       "write one page, to open offline: findings, ranks, points, figures and claims")            \
  VERB(answers, true, "compare each solver with exact answers (orbits, oscillations, falls)")     \
  VERB(film, false, "render a scene as stills or a film, or export it for ParaView and Blender")  \
  VERB(choose, false, "recommend a solver and a step for a scene, after a minute of measuring")   \
  VERB(check, false, "test what every solver must fulfil, and say where to look if one does not") \
  VERB(budget, false, "strain and error of each method within a frame budget")                    \
  VERB(claims, false, "decide the paper's claims from result files")                              \
  VERB(results, false, "write tables of result files in Markdown (docs/results.md)")              \
  VERB(compare, false,                                                                            \
       "compare two results point by point: what is slower, less accurate or fails now")          \
  VERB(baseline, false, "reduce results to a file without times, to compare with later")          \
  VERB(ab, false, "compare the speed of two builds in interleaved pairs of runs")                 \
  VERB(tune, true,                                                                                \
       "search the settings of each solver, by one rule, on scenes that no result reports")       \
  VERB(reference, false, "compute the trajectories that errors are measured against")             \
  VERB(point, false, "run single points, given as JSON on standard input, one a line")            \
  VERB(list, false, "print what there is: solvers, scenes, suites, verbs, cases and more")

#define HARNESS_DECLARE(name, children, summary) Action name##_verb(const Command& command);
HARNESS_VERBS(HARNESS_DECLARE)
#undef HARNESS_DECLARE

inline std::vector<Verb> verbs() {
#define HARNESS_ROW(name, children, summary) {#name, summary, name##_verb, children},
  return {HARNESS_VERBS(HARNESS_ROW)};
#undef HARNESS_ROW
}

}  // namespace harness
