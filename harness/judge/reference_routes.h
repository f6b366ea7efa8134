// References and ensembles by computation: two unlike routes for each scene.
#pragma once

#include <string>
#include <vector>

#include "harness/judge/route_runs.h"

namespace harness {

// Computes the reference of a scene by both routes. finest: the smallest step of step halving, s; 0
// chooses by the scene. Throws UsageError if a route fails too early.
Reference compute_reference(const std::string& scene, const SceneParameters& complete,
                            double finest, RouteRuns& runs);

// In its place for a scene of one's own: one route alone, in steps of 1/400 s, whose gap is how far
// it is from itself at 1/200 s and from a start moved a little. Throws UsageError if it fails too
// early, and what `tell` throws.
Reference finer_run(const std::string& scene, const SceneParameters& complete, const Tell& tell);

struct EnsemblePlan {
  // s; divides the sample interval. Far below the steps that are judged, and affordable.
  double step = sample_interval / 160;
  int runs_of_a_route = 8;
  double moved = 1e-4;  // a start's coordinates, at most, over the shortest edge
};
constexpr int fewest_runs = 8;  // of an ensemble, of both routes together

// Ensemble of a scene of cloth at these times, by the routes of its reference. A run that fails, or
// whose energy rises beyond the scene's bound, is left out; with fewer than the fewest runs there
// is no ensemble, with a reason.
Ensemble compute_ensemble(const Scene& scene, const std::vector<double>& times,
                          const EnsemblePlan& plan, RouteRuns& runs);

}  // namespace harness
