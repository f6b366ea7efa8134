// A point of a sweep: what is run, and what came of it. docs/measuring.md says what each figure
// means.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "harness/scenes/scene.h"
#include "inextensible/registry.h"

namespace harness {

struct PointSpec {
  std::string sweep;  // "strain", "resolution" or "step"
  std::string scene;
  SceneParameters scene_parameters;  // complete
  int resolution = 0;                // the scene's own resolution parameter
  int vertices = 0, constraints = 0;
  std::string solver;
  inextensible::Settings settings;  // given ones only
  double strain_limit = 0.01;
  double step = 0.01;     // s
  bool adaptive = false;  // `step` is the largest one of a step controller
  std::uint64_t seed = 1;

  std::string id()
      const;  // drape/fast_projection/n:5041/strain:0.01/h:0.004 (adaptive: /h:adaptive)
};

enum class PointStatus {
  ok,
  strain_missed,
  not_converged,
  diverged,
  timeout,
  out_of_memory,
  crashed,
  unsupported,
  skipped,
};
const char* to_string(PointStatus status);

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // written as null

// The judge's figures, from positions alone, off the clock.
struct Measures {
  double max_strain = 0, max_stretch = 0;             // over all steps
  double p99_strain = unknown, rms_strain = unknown;  // over edges and sampled instants
  double max_strain_after_collision = unknown;        // over all steps, with a collider only
  double energy_drift =
      unknown;  // largest |E - E_0| over weight times size, where nothing dissipates
  double symmetry_defect = unknown;  // largest distance to the mirror image, over the scene's size
  double kinetic_energy_mean = unknown;  // J, over sampled instants

  // Against a reference, where there is one; all over the scene's size.
  std::string reference;            // its name, "" if there is none
  double trajectory = unknown;      // RMS over vertices (by mass) and samples up to valid_until
  double trajectory_max = unknown;  // largest distance of a vertex
  double gap = unknown;             // the reference's own uncertainty, as `trajectory`
  double valid_until = unknown;     // s
  double shape_potential_energy = unknown, shape_corner_height = unknown,
         shape_shadow = unknown;  // RMS over samples after valid_until
  // Fast projection's F, mean over vertices and sampled steps, m, after the first and the last
  // iteration; and over time.
  double residual_first = unknown, residual_last = unknown;
  struct ResidualSample {
    double time, first, last;  // s, m, m
  };
  std::vector<ResidualSample> residuals;
};

struct PointResult {
  PointSpec spec;
  PointStatus status = PointStatus::skipped;
  std::string detail;
  std::vector<double> samples;  // wall seconds per simulated second, one a run
  double setup_seconds = 0, calibration_seconds = 0;
  int calibration_runs = 0;
  std::optional<double> stiffness;  // EA, N, found by calibration
  inextensible::PhaseSeconds phases;
  inextensible::WorkCounters work;
  Measures measures;
  double smallest_step = unknown;  // s, of the accepted ones of a step controller
  int steps_planned = 0;
  std::string linear_solver;
  double peak_rss_bytes = 0;
  bool best = false;           // the fastest of its search
  bool best_at_error = false;  // the fastest of those within the suite's error limit

  bool ok() const { return status == PointStatus::ok; }
  double median_seconds() const;  // of the samples
};

double quantile(std::vector<double> samples, double fraction);

// Half the width of the median's 95 % confidence interval over the median, from order statistics
// (no assumption on the distribution); infinite below six samples, which cannot tell.
double median_uncertainty(std::vector<double> samples);

}  // namespace harness
