// Invented points for tests of claims.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <tuple>
#include <utility>

#include "harness/claims/claims.h"
#include "support/invented_runs.h"

namespace harness {

using nlohmann::json;

// The best point of its contestant, right to 2 %, in steps of two iterations.
inline json point(const std::string& scene, const std::string& sweep, const std::string& solver,
                  double limit, int vertices, double step, double seconds) {
  PointResult point = invented::sampled(scene, sweep, solver, limit, vertices, step, seconds);
  point.best = true;
  point.best_at_errors = {0.02};
  point.measures.trajectory = 0.01;
  point.measures.gap = 1e-9;
  point.measures.max_strain = limit;
  point.work.steps = std::lround(1 / step);
  point.work.iterations = 2 * point.work.steps;
  return to_json(point);
}

// noise: q95 of the A/A pair; 0: there is none.
inline json document(const std::vector<json>& points, double noise = 0) {
  json result{{"points", points}};
  if (noise > 0)
    result["context"]["noise"] = {{"pair", {"fast_projection", "fast_projection_again"}},
                                  {"places", 20},
                                  {"median", noise / 3},
                                  {"q95", noise}};
  return result;
}

inline ClaimVerdict verdict_in(const std::string& id, const json& result) {
  const auto claims = judge_claims({result});
  const auto found = std::ranges::find(claims, id, &ClaimVerdict::id);
  EXPECT_NE(found, claims.end());
  EXPECT_FALSE(found->verdict == "not yet measured" && !found->points.empty());
  return *found;
}

inline ClaimVerdict verdict(const std::string& id, const std::vector<json>& points,
                            double noise = 0) {
  return verdict_in(id, document(points, noise));
}

// Verdicts on the points that `with` makes of each row's numbers.
template <std::size_t Numbers, class With>
void expect_verdicts(
    const With& with,
    std::initializer_list<std::pair<std::array<double, Numbers>, const char*>> rows) {
  for (const auto& [numbers, wanted] : rows)
    EXPECT_EQ(std::apply(with, numbers).verdict, wanted) << ::testing::PrintToString(numbers);
}

inline bool says(const ClaimVerdict& claim, const std::string& words) {
  EXPECT_NE(claim.measured.find(words), std::string::npos) << claim.measured;
  return claim.measured.find(words) != std::string::npos;
}

inline constexpr double limits[] = {0.1, 0.03, 0.01, 0.003, 0.001};

// Time falls off as limit^exponent.
inline void strain_curve(std::vector<json>& points, const std::string& scene,
                         const std::string& solver, double at_ten_percent, double exponent,
                         double step = 0.01) {
  for (const double limit : limits)
    points.push_back(point(scene, "strain", solver, limit, 80, step,
                           at_ten_percent * std::pow(limit / 0.1, exponent)));
}

}  // namespace harness
