// The search for the stiffness of springs that keeps a strain limit.
#pragma once

#include "harness/points/point.h"

namespace harness {

struct CalibrationTrial {
  PointStatus status = PointStatus::ok;  // strain_missed: beyond the limit
  double strain = 0;                     // the largest, up to where the run ended
  double seconds = 0;
  std::string detail;
};
// A trial may be cut short at this many times the limit.
inline constexpr double calibration_cut_short = 2;
inline constexpr int calibration_run_limit = 16, calibration_failure_limit = 6;

struct Calibration {
  // The softest stiffness tried that met the limit; none if there is none (status then says why).
  std::optional<double> stiffness;
  int runs = 0;
  PointStatus status = PointStatus::strain_missed;
  std::string detail = "no stiffness keeps the strain within the limit";
};

// Finds the stiffness EA at which the run's own maximum strain just meets the limit. Strain is
// tension over stiffness, and tension hardly depends on stiffness: that law leads from a guess to a
// bracket, and Brent's method (GSL) on log strain / limit over log EA does the rest. A run that
// times out says nothing about its strain: it ends the search without a stiffness, with the status
// `skipped`. After any other failure the search tries stiffer and softer springs, since Newton's
// iteration may fail on either side. guess: EA, N.
Calibration calibrate_stiffness(double strain_limit, double guess,
                                const std::function<CalibrationTrial(double stiffness)>& run);

// s, of a spring method's counted work on a usual machine, within a factor of two; repeatable.
double nominal_seconds(const WorkCounters& work, int edges);

// N: an estimate to begin a search from.
double first_stiffness(const Scene& scene, double strain_limit);

}  // namespace harness
