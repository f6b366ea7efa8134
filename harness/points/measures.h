// The judge's figures of a run, from positions alone, off the clock.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "harness/base/fields.h"

namespace harness {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // written as null

// A distance to the reference is certainly an error of the run if it is above this many gaps.
constexpr double sure_gaps = 3;

// Levels of error over the scene's size that an answer may be asked for at, loose to tight, and the
// one of headlines. Without a level any motion will do.
inline constexpr std::array answer_levels{0.1, 0.05, 0.02, 0.01, 0.005};
inline constexpr double headline_error = 0.02;
inline constexpr double any_motion = std::numeric_limits<double>::infinity();

struct ResidualSample {
  double time, first, last;  // s, m, m
  bool operator==(const ResidualSample&) const = default;
};

// At a sample time of the reference: distances to it, root mean square over vertices (by mass) and
// largest, and the reference's own uncertainty in both norms.
struct ErrorSample {
  double time, error, worst;  // s, scene's size
  double gap, worst_gap;      // scene's size
  bool operator==(const ErrorSample&) const = default;
};

// The distance to the reference at a level: over the sample times at which 3 gap is at most the
// level. These are the same for all runs, so that "within an error of 1 %" means one thing.
struct ErrorAtLevel {
  double level = any_motion;
  double distance = unknown;  // largest root mean square over vertices; unknown without a sample
  double mean = unknown;      // of these over time
  double largest = unknown;   // of any vertex
  double gap = unknown;       // the largest
  double samples = 0;
  double until = 0;  // s, the last sample
  bool operator==(const ErrorAtLevel&) const = default;
};

// What each means: measure_fields.
struct Measures {
  double max_strain = 0, p99_strain = unknown, rms_strain = unknown;
  double max_strain_after_collision = unknown;
  double kinetic_energy_mean = unknown;
  double energy_drift = unknown, energy_gain = unknown, energy_rise = unknown;
  std::string reference;
  double trajectory = unknown, trajectory_mean = unknown, trajectory_max = unknown, gap = unknown;
  int error_samples = 0;
  double error_until = unknown;
  std::string unknown_because;
  std::vector<ErrorSample> error_series;  // of a run; files have error_levels instead
  std::vector<ErrorAtLevel> error_levels;
  double moved = unknown, valid_until = unknown;
  std::vector<ResidualSample> residuals;
  std::map<std::string, double> sag;
  double rest_speed = unknown;
};

inline constexpr FieldTraits number_or_null{.nullable = true};
inline constexpr FieldTraits error_or_null{.inside = "error", .nullable = true};

// "scene's size": over it, so that scenes compare.
inline constexpr std::tuple measure_fields{
    field("max_strain", &Measures::max_strain, "", "largest |strain| of an edge, over all steps",
          number_or_null),
    field("p99_strain", &Measures::p99_strain, "",
          "99 % of |strain|s lie below it, over edges and sampled instants", number_or_null),
    field("rms_strain", &Measures::rms_strain, "",
          "root mean square strain, over edges and sampled instants", number_or_null),
    field("max_strain_after_collision", &Measures::max_strain_after_collision, "",
          "largest |strain| after the collision filter, over all steps; with a collider only",
          number_or_null),
    field("kinetic_energy_mean", &Measures::kinetic_energy_mean, "J",
          "kinetic energy, mean over sampled instants", number_or_null),
    field("energy_drift", &Measures::energy_drift, "weight times size",
          "largest |E - E_0|, over all steps, where nothing dissipates", error_or_null),
    field("energy_gain", &Measures::energy_gain, "weight times size",
          "largest E - E_0, over all steps; negative: energy was lost throughout", error_or_null),
    field("energy_rise", &Measures::energy_rise, "weight times size",
          "sum of all rises of E between means over 0.01 s, where energy can only fall",
          error_or_null),
    field("reference", &Measures::reference, "",
          "name of the reference in results/references; null: there is none", error_or_null),
    field("trajectory", &Measures::trajectory, "scene's size",
          "distance to the reference as root mean square over vertices (by mass), the largest over "
          "the sample times at which 3 gap is at most 0.02, the same for all runs; null: see "
          "unknown_because",
          error_or_null),
    field("trajectory_mean", &Measures::trajectory_mean, "scene's size",
          "the same, mean over these times", error_or_null),
    field("trajectory_max", &Measures::trajectory_max, "scene's size",
          "largest distance of a vertex to the reference, over the same times", error_or_null),
    field("gap", &Measures::gap, "scene's size",
          "the reference's own uncertainty, the largest over the same times", error_or_null),
    field("error_samples", &Measures::error_samples, "samples", "how many these are",
          {.inside = "error"}),
    field("error_until", &Measures::error_until, "s", "time of the last of them", error_or_null),
    field("unknown_because", &Measures::unknown_because, "", "why there is no trajectory error",
          error_or_null),
    field("error_series", &Measures::error_series, "s, then scene's size",
          "at each sample: time, distance to the reference as root mean square and as maximum, gap "
          "in both norms; in older files",
          error_or_null),
    field("error_levels", &Measures::error_levels, "scene's size",
          "a level, which holds down to the next row's; then over the sample times at which 3 gap "
          "is at most the level the distance to the reference as root mean square over vertices, "
          "largest and mean, the largest of any vertex, the largest gap, the number of samples and "
          "the time of the last one (s)",
          error_or_null),
    field("moved", &Measures::moved, "",
          "distance from the start over the reference's, root mean square over vertices and "
          "samples; 0: it did not move",
          error_or_null),
    field("valid_until", &Measures::valid_until, "s",
          "up to here the reference is known to 1 % of the scene's size", error_or_null),
    field("residuals", &Measures::residuals, "s, m, m",
          "time, fast projection's mean |F| over vertices after the first and after the last "
          "iteration; of step sweeps alone, so that files stay small",
          {.inside = "error"}),
    field("sag", &Measures::sag, "m",
          "how far the vertices that the scene marks are below where they would hang if nothing "
          "stretched, mean over the last third of the run"),
    field("rest_speed", &Measures::rest_speed, "m/s",
          "root mean square over vertices (by mass) and the last third of the run, of scenes that "
          "mark vertices: 0 at rest",
          number_or_null)};

// From the series; without one, from the levels, at one of answer_levels; without these, too, the
// one figure counts for all levels.
ErrorAtLevel error_at(const Measures& measures, double level);
// The series at answer_levels, loose to tight; a level that is as the one before it is left out.
std::vector<ErrorAtLevel> levels_of_series(const Measures& measures);
// Whether it is known to be at most the level; any_motion: always.
bool within_error(const Measures& measures, double level);
// The same, or that nothing is known at the level.
bool within_known_error(const Measures& measures, double level);

}  // namespace harness
