// Result documents whose times are made up, for tests of what is concluded from them.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

#include "harness/claims/claims.h"
#include "harness/points/point_json.h"

namespace harness::invented {

// A run by nine samples, 0.1 % apart, the least as given: sure unless a test says otherwise.
inline PointResult sampled(const std::string& scene, const std::string& sweep,
                           const std::string& contestant, double limit, int vertices, double step,
                           double seconds) {
  PointResult point(
      {.sweep = sweep,
       .scene = scene,
       .scene_parameters = {{"n", vertices}, {"duration", 1}, {"mass", 1}, {"gravity", 9.81}},
       .resolution = vertices,
       .vertices = vertices,
       .contestant = contestant,
       .solver = contestant.substr(0, contestant.find("_untuned")),
       .settings = {},
       .strain_limit = limit,
       .step = step},
      PointStatus::ok);
  for (int i = 0; i < 9; ++i) point.samples.push_back(seconds * (1 + 0.001 * i));
  return point;
}

// A run of a chain of 80 that is off by `error`. The reference is known to within 0.1 % at 0.5 s,
// and to 6 % at 1 s, where every run is off by 40 %.
inline json run(const std::string& contestant, double limit, double step, double seconds,
                double error, bool best = false, const std::vector<double>& best_at_errors = {}) {
  PointResult point = sampled("chain", "strain", contestant, limit, 80, step, seconds);
  point.best = best;
  point.best_at_errors = best_at_errors;
  point.measures.reference = "chain-n80.json";
  point.measures.trajectory = error;
  point.measures.error_series = {{0.5, error, error, 0.0003, 0.0003}, {1.0, 0.4, 0.4, 0.02, 0.02}};
  return to_json(point);
}

inline json document(const std::vector<json>& points) {
  return {{"schema", "inextensible-bench/1"},
          {"context", {{"suite", {{"finest_error", 0.01}}}}},
          {"legend",
           {{"solvers",
             {{{"name", "yarn_projection"}, {"family", "yarn_projection"}},
              {{"name", "icd"}, {"family", "icd"}},
              {{"name", "icd_untuned"}, {"solver", "icd"}, {"family", "icd"}, {"unranked", true}},
              {{"name", "shake"}, {"family", "shake"}},
              {{"name", "null"}, {"family", "none"}, {"contestant", false}}}}}},
          {"points", points}};
}

}  // namespace harness::invented

namespace harness {

// ---- Points of claims ----

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

// Time falls off as limit^exponent.
inline void strain_curve(std::vector<json>& points, const std::string& scene,
                         const std::string& solver, double at_ten_percent, double exponent,
                         double step = 0.01) {
  for (const double limit : {0.1, 0.03, 0.01, 0.003, 0.001})
    points.push_back(point(scene, "strain", solver, limit, 80, step,
                           at_ten_percent * std::pow(limit / 0.1, exponent)));
}

}  // namespace harness
