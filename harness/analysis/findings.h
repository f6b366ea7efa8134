// The answers of result files in plain words. The terminal, the page of results, figures and the
// report print these sentences; none makes its own.
#pragma once

#include <string>
#include <vector>

#include "harness/analysis/plane.h"
#include "harness/base/statistics.h"

namespace harness::analysis {

// Growth of one row of the ranking, at its fastest runs for any motion.
struct RowGrowth {
  std::string row;
  Slope exponent;           // of the time of a step over the number of vertices
  Point smallest, largest;  // runs of the least and the most vertices
};

struct Growth {
  std::string scene;
  double strain_limit = 0;
  std::vector<RowGrowth> rows;  // with runs at two sizes at least; slowest growth first
};

// One for each scene and strain limit that resolution sweeps have.
std::vector<Growth> growth_in(const std::vector<Plane>& planes);

// "1.13 (1.05 to 1.21)"; without an interval where two sizes are all.
std::string exponent_words(const Slope& exponent);

// About one plane; of a resolution sweep, about that of the most vertices and the growth up to it.
struct Finding {
  std::string scene, sweep;
  int vertices = 0;
  std::string subject;  // "drape of 5041 vertices"
  // The answer at the limit next to 1 % and the headline's error, or the nearest question that has
  // an answer; then what a tighter limit, or a motion of any kind, changes.
  std::vector<std::string> sentences;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, scene, sweep, vertices, subject, sentences)

// "At 1 % strain, motion error at most 2 %, x is the fastest: 41.3 ms a simulated second with steps
// of 1/200 s and an error of 1.4 %; y, the best of the paper's six, takes 2.1 (1.9-2.3) times as
// long."
std::string sentence_of(const Cell& cell);
// "From 441 to 10201 vertices the time of a step grows least with x, as their number to the power
// 1.1 (1.0 to 1.2), and most with y, 1.6 (1.5 to 1.7)." Of rows that have all sizes; "" for less
// than two of them.
std::string sentence_of(const Growth& growth);

std::vector<Finding> findings_of(const std::vector<Plane>& planes);

// "chain, 80 vertices, over strain". Planes of one title are one table: those of a resolution sweep
// are its rows.
std::string title_of(const Plane& plane);
// A sentence on the time until which errors at the headline's level count. Empty: they are not
// known.
std::string span_of_errors(const std::vector<Plane>& planes);

// As JSON, schema inextensible-analysis/1: for `bench show --json` and for figures.
nlohmann::json analysis_of(const Runs& runs);

}  // namespace harness::analysis
