// The runs that an ensemble is made of.
#pragma once

#include <string>
#include <vector>

#include "harness/judge/ensemble.h"
#include "harness/judge/route_runs.h"

namespace harness {

struct EnsemblePlan {
  // s; divides the sample interval. Far below the steps that are judged, and affordable.
  double step = sample_interval / 160;
  int runs_of_a_route = 8;
  double moved = 1e-4;  // a start's coordinates, at most, over the shortest edge
};
constexpr int fewest_runs = 8;  // of an ensemble, of both routes together

// Ensemble of a scene of cloth at these times, by the routes of its reference. A run that fails, or
// whose energy rises beyond the scene's bound, is left out; with fewer than the fewest runs there
// is no ensemble, with a reason. tell, keep: as of compute_reference.
Ensemble compute_ensemble(const Scene& scene, const std::vector<double>& times,
                          const EnsemblePlan& plan, const Tell& tell, const KeepRun& keep);

}  // namespace harness
