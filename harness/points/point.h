// A point of a sweep: what is run, and what came of it. docs/measuring.md says what each figure
// means.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/points/measures.h"
#include "harness/points/status.h"
#include "harness/scenes/scene.h"
#include "solvers/registry.h"

namespace harness {

struct PointSpec {
  std::string sweep;  // "strain", "resolution" or "step"
  std::string scene;
  SceneParameters scene_parameters;  // complete
  int resolution = 0;                // the scene's own resolution parameter
  int vertices = 0, constraints = 0;
  std::string contestant;  // empty: the solver under its own name
  std::string solver;
  inextensible::Settings settings;  // given ones only
  double strain_limit = 0.01;
  double step = 0.01;     // s
  bool adaptive = false;  // `step` is the largest one of a step controller
  std::uint64_t seed = 1;

  const std::string& name() const { return contestant.empty() ? solver : contestant; }
  std::string id()
      const;  // drape/fast_projection/n:5041/strain:0.01/h:0.004 (adaptive: /h:adaptive)
};

// Frames a second of film, television and games.
inline constexpr std::array frame_rates{24.0, 30.0, 60.0};

// Wall time of a frame at a rate of pictures, over the frames of a run, s.
struct FrameTime {
  double rate;  // frames a second
  double median, slow, worst;
  bool operator==(const FrameTime&) const = default;
};

// Samples of a point's time, and what was measured beside them.
struct Samples {
  // Wall seconds per simulated second. A sample is one run, or of a short run the mean of several.
  std::vector<double> samples = {};
  std::vector<double> cpu_samples =
      {};  // processor time of the thread in the same runs; may be empty
  std::vector<double> filter_samples = {};  // the same, spent in the inextensibility filter
  std::vector<int> sample_runs = {};        // runs that each sample is the mean of; may be empty
  int retaken = 0;                          // samples taken again because something disturbed them
  std::vector<FrameTime> frame_times = {};  // of a run of the fastest sample
};

struct PointResult : Samples {
  PointResult() = default;
  explicit PointResult(PointSpec what, PointStatus how = PointStatus::skipped)
      : spec(std::move(what)), status(how) {}

  PointSpec spec;
  PointStatus status = PointStatus::skipped;
  std::string detail;
  double setup_seconds = 0, calibration_seconds = 0;
  int calibration_runs = 0;
  double calibration_guess = unknown;  // N, where the search began; unknown: at an estimate
  std::optional<double> stiffness;     // EA, N, found by calibration
  inextensible::PhaseSeconds phases;   // of the run of the first filter sample
  inextensible::WorkCounters work;
  Measures measures;
  double smallest_step = unknown;  // s, of the accepted ones of a step controller
  int steps_planned = 0;
  std::string linear_solver;
  double peak_rss_bytes = 0;
  bool best = false;                   // the fastest of its search, whatever its motion
  std::vector<double> best_at_errors;  // levels of error that it is the fastest within
  // For a best point: "coarsest" or "finest" where a step beyond the ladder might be better still.
  std::string at_ladder_end;

  bool ok() const { return status == PointStatus::ok; }
  double seconds() const;           // the point's time: of its samples, by time_of()
  double measured_seconds() const;  // s that the runs of all samples took together
  double filter_seconds() const;    // of the filter's samples, by time_of()
  double mean_step() const;         // s; the spec's, but for adaptive steps
};

// Frame times replace the point's if there are any: they are those of a faster sample.
void append(const Samples& more, PointResult& point);

// Half the width of the median's 95 % confidence interval over the median, from order statistics
// (no assumption on the distribution); infinite below six samples, which cannot tell.
double median_uncertainty(std::vector<double> samples);

}  // namespace harness
