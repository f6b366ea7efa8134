// The answers of result files in words, as the terminal, pages and figures print them.
#pragma once

#include "harness/analysis/plane.h"

namespace harness::analysis {

// On one plane; for a resolution sweep on the largest one.
struct Finding {
  std::string scene, sweep;
  int vertices = 0;
  std::string subject;  // "drape of 5041 vertices"
  // The answer at the limit next to 1 % and the headline's error, or to the nearest question that
  // has one; then what a tighter limit, or any motion, changes.
  std::vector<std::string> sentences;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, scene, sweep, vertices, subject, sentences)

// "At 1 % strain, motion error at most 2 %, x is the fastest: 41.3 ms a simulated second with steps
// of 1/200 s and an error of 1.4 %; y, the best of the paper's six, takes 2.1 (1.9-2.3) times ..."
std::string sentence_of(const Cell& cell);
std::vector<Finding> findings_of(const std::vector<Plane>& planes);

// "chain, 80 vertices, over strain". Planes of one title, as of a resolution sweep, share a table.
std::string title_of(const Plane& plane);
// A sentence on the time until which errors at the headline's level are known; "" if they all are.
std::string span_of_errors(const std::vector<Plane>& planes);

// JSON of schema inextensible-analysis/1, for `bench show --json` and figures.
json analysis_of(const Runs& runs);

}  // namespace harness::analysis
