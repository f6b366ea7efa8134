// The judge's figures of a run, from positions alone, off the clock.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "harness/base/fields.h"

namespace harness {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // written as null

struct ResidualSample {
  double time, first, last;  // s, m, m
  bool operator==(const ResidualSample&) const = default;
};

// What each means: measure_fields.
struct Measures {
  double max_strain = 0, max_stretch = 0;
  double p99_strain = unknown, rms_strain = unknown;
  double max_strain_after_collision = unknown;
  double kinetic_energy_mean = unknown;
  double energy_drift = unknown;
  double symmetry_defect = unknown;
  std::string reference;
  double trajectory = unknown, trajectory_max = unknown;
  double gap = unknown;
  double valid_until = unknown;
  double shape_potential_energy = unknown, shape_corner_height = unknown, shape_shadow = unknown;
  double residual_first = unknown, residual_last = unknown;
  std::vector<ResidualSample> residuals;
};

inline constexpr FieldTraits number_or_null{.nullable = true};
inline constexpr FieldTraits error_or_null{.inside = "error", .nullable = true};

// "scene's size": over it, so that scenes compare.
inline constexpr std::tuple measure_fields{
    field("max_strain", &Measures::max_strain, "", "largest |strain| of an edge, over all steps",
          number_or_null),
    field("max_stretch", &Measures::max_stretch, "", "largest extension of an edge, over all steps",
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
          "largest |E - E_0|, where nothing dissipates", error_or_null),
    field("symmetry_defect", &Measures::symmetry_defect, "scene's size",
          "largest distance to the mirror image", error_or_null),
    field("reference", &Measures::reference, "",
          "name of the reference in results/references; null: there is none", error_or_null),
    field("trajectory", &Measures::trajectory, "scene's size",
          "distance to the reference, root mean square over vertices (by mass) and samples up to "
          "valid_until",
          error_or_null),
    field("trajectory_max", &Measures::trajectory_max, "scene's size",
          "largest distance of a vertex to the reference, up to valid_until", error_or_null),
    field("gap", &Measures::gap, "scene's size", "the reference's own uncertainty, as trajectory",
          error_or_null),
    field("valid_until", &Measures::valid_until, "s",
          "up to here the reference is one trajectory, not one of many", error_or_null),
    field("shape_potential_energy", &Measures::shape_potential_energy, "weight times size",
          "potential energy against the reference's, root mean square after valid_until",
          error_or_null),
    field("shape_corner_height", &Measures::shape_corner_height, "scene's size",
          "height of the corners against the reference's, root mean square after valid_until",
          error_or_null),
    field("shape_shadow", &Measures::shape_shadow, "scene's size squared",
          "area of the shadow against the reference's, root mean square after valid_until",
          error_or_null),
    field("residual_first", &Measures::residual_first, "m",
          "fast projection's mean |F| over vertices and sampled steps, after the first iteration",
          error_or_null),
    field("residual_last", &Measures::residual_last, "m", "the same after the last iteration",
          error_or_null),
    field("residuals", &Measures::residuals, "s, m, m",
          "time, mean |F| after the first and after the last iteration; of step sweeps alone, so "
          "that files stay small",
          {.inside = "error"})};

}  // namespace harness
