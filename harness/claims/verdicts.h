// How verdicts follow from numbers with intervals.
#pragma once

#include <string>
#include <vector>

#include "harness/analysis/words.h"
#include "harness/base/fit.h"
#include "harness/base/statistics.h"

namespace harness::claims {

// Verdicts.
constexpr const char* reproduced = "reproduced";
constexpr const char* not_reproduced = "not reproduced";
constexpr const char* changed = "changed";      // in part, or by another amount
constexpr const char* undecided = "undecided";  // an interval has values on both sides
constexpr const char* not_measured = "not yet measured";

// What an interval says of a statement; open: it has values on both sides.
enum class Answer { yes, no, open };

Answer above(const Ratio& ratio, double threshold);
Answer above(const Slope& slope, double threshold);
Answer below(const Slope& slope, double threshold);
Answer all_of(const std::vector<Answer>& answers);  // no if one is no

std::string verdict_of(Answer answer);
// Verdict on a claim in two parts: one yes and one no is `changed`.
std::string verdict_of(Answer one, Answer other);
// Counts of places: not reproduced if not so at most, changed if so at most, undecided if at half.
std::string verdict_of_counts(int yes, int no, int all);
// Verdict on a claim judged in several ways; a way that was not measured does not count.
std::string verdict_of_all(const std::vector<std::string>& verdicts);

std::string text(double value, int digits = 3);
std::string text(const Slope& slope);  // "-0.5 ± 0.1", with its 95 % interval
using analysis::percent;
using analysis::text;  // of a ratio

}  // namespace harness::claims
