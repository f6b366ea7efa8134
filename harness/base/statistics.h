// Two samples of times compared without assumptions about how times are distributed.
#pragma once

#include <vector>

namespace harness {

// The one-sided Mann-Whitney test (1947): how likely values of `a` are at least as far above those
// of `b` as they are, if both came from one distribution. Ties share their ranks. Exact, ties
// included, up to exact_up_to values in all; the normal approximation corrected for ties and
// continuity above. 1 if either is empty.
double mann_whitney_greater(const std::vector<double>& a, const std::vector<double>& b);
constexpr std::size_t exact_up_to = 60;

// The least value that mann_whitney_greater can have for that many values: 1 / (a + b over a).
double least_possible_p(std::size_t a, std::size_t b);

}  // namespace harness
