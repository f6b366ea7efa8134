#include "harness/claims/verdicts.h"

#include <algorithm>
#include <cmath>

#include "harness/base/text.h"

namespace harness::claims {

Answer above(const Ratio& ratio, double threshold) {
  if (ratio.above(threshold)) return Answer::yes;
  return ratio.below(threshold) ? Answer::no : Answer::open;
}

Answer above(const Slope& slope, double threshold) {
  if (slope.low() > threshold) return Answer::yes;
  return slope.high() < threshold ? Answer::no : Answer::open;
}

Answer below(const Slope& slope, double threshold) {
  const Answer answer = above(slope, threshold);
  return answer == Answer::open ? answer : answer == Answer::yes ? Answer::no : Answer::yes;
}

Answer all_of(const std::vector<Answer>& answers) {
  const auto has = [&](Answer one) {
    return std::find(answers.begin(), answers.end(), one) != answers.end();
  };
  return has(Answer::no) ? Answer::no : has(Answer::open) ? Answer::open : Answer::yes;
}

std::string verdict_of(Answer answer) {
  return answer == Answer::yes ? reproduced : answer == Answer::no ? not_reproduced : undecided;
}

std::string verdict_of(Answer one, Answer other) {
  return verdict_of_all({verdict_of(one), verdict_of(other)});
}

std::string verdict_of_counts(int yes, int no, int all) {
  if (yes == all) return reproduced;
  if (2 * no > all) return not_reproduced;
  return no > 0 && 2 * yes > all ? changed : undecided;
}

std::string verdict_of_all(const std::vector<std::string>& verdicts) {
  std::string common = not_measured;
  bool open = false;
  for (const std::string& verdict : verdicts) {
    if (verdict == not_measured) continue;
    open = open || verdict == undecided;
    if (common == not_measured) common = verdict;
    if (common != verdict) common = changed;
  }
  return open ? undecided : common;
}

std::string text(double value, int digits) { return number_text(value, digits); }

std::string text(const Slope& slope) {
  return text(slope.value, 2) +
         (std::isfinite(slope.half_width) ? " ± " + text(slope.half_width, 1) : "");
}

}  // namespace harness::claims
