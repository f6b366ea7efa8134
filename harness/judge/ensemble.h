// An ensemble: runs of a scene by both routes of its reference from starts that are moved a little.
// Where paths are chaotic, it says how far runs that are all right are apart, in the statistics of
// shape.h. A run's shape error is what it deviates beyond that.
#pragma once

#include <string>
#include <vector>

#include "harness/judge/shape.h"
#include "harness/points/measures.h"

namespace harness {

constexpr double sure_deviations = 3;  // standard deviations that are no error
// Mean kinetic energy over the ensemble's: a run below hangs, one above shakes. What first-order
// methods dissipate at steps of 1/50 s leaves 0.68 to 0.74 on the drape.
constexpr double least_kinetic_ratio = 0.6, largest_kinetic_ratio = 1.25;

struct Ensemble {
  std::vector<std::string> methods;  // of the runs: solver, limit, step, how many of them
  double moved = 0;                  // a start's coordinates, at most, over an edge's length
  int runs = 0;                      // that came to the end
  ShapeSeries mean, deviation;       // at the reference's times; standard deviation of one run
  // The same of a run's kinetic energy averaged over the times up to each.
  std::vector<double> kinetic_deviation;
  std::string unknown_because;  // why there is none; "" if there is one, or it was never tried

  bool known() const { return !mean.empty(); }
};

// Mean and standard deviation (with n - 1) of runs that have come to the end, two at least.
Ensemble ensemble_of(const std::vector<ShapeSeries>& runs);

struct ShapeError {
  double error = unknown;           // over size, weight times size or size squared
  const char* statistic = "";       // which is that far off; "" where the error is 0
  double time = unknown;            // s, when
  double kinetic_ratio = unknown;   // kinetic energy over the ensemble's, means over times
  double kinetic_spread = unknown;  // three standard deviations of that
};
// Shape error of a run over its first samples; times: the reference's. Unknown without a sample.
ShapeError shape_error(const Ensemble& ensemble, const std::vector<double>& times,
                       const ShapeSeries& run);

// Whether that ratio is a run's that hangs or shakes.
bool kinetic_energy_lost(double ratio, double spread);

}  // namespace harness
