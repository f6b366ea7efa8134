// Result documents whose times are made up, for tests of what is concluded from them.
#pragma once

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
