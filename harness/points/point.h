// A point of a sweep: what is run, and what came of it. docs/measuring.md says what each figure
// means.
#pragma once

#include "harness/points/measures.h"
#include "harness/scenes/scene.h"
#include "solvers/registry.h"

namespace harness {

using inextensible::Backend, inextensible::backends, inextensible::find_backend,
    inextensible::make_stepper, inextensible::PhaseSeconds, inextensible::Settings,
    inextensible::Status, inextensible::Stepper, inextensible::StepResult,
    inextensible::StrainControl, inextensible::Velocities, inextensible::WorkCounters;

// How a run ended.
enum class PointStatus {
  ok,
  strain_missed,
  energy_gained,
  motion_lost,
  body_crossed,
  not_converged,
  diverged,
  timeout,
  out_of_memory,
  crashed,
  unsupported,
  skipped,
};

struct PointStatusInfo {
  PointStatus status;
  const char* name;
  const char* letter;  // of a failure, in figures
  const char* meaning;
};

// In the order of PointStatus. Files, schemas, figures and `bench list statuses` follow it.
inline constexpr std::array point_statuses{
    PointStatusInfo{PointStatus::ok, "ok", "", "ran to the end within its strain limit"},
    PointStatusInfo{PointStatus::strain_missed, "strain_missed", "S",
                    "an edge was strained more than permitted"},
    PointStatusInfo{PointStatus::energy_gained, "energy_gained", "E",
                    "energy rose by more than the scene's bound"},
    PointStatusInfo{PointStatus::motion_lost, "motion_lost", "M",
                    "moved less than half as far as the reference"},
    PointStatusInfo{PointStatus::body_crossed, "body_crossed", "B",
                    "vertices passed through the body within a step"},
    PointStatusInfo{PointStatus::not_converged, "not_converged", "N",
                    "the solver refused a step: out of iterations, or no progress"},
    PointStatusInfo{PointStatus::diverged, "diverged", "D",
                    "a position was not finite, or an edge was strained more than tenfold"},
    PointStatusInfo{PointStatus::timeout, "timeout", "T",
                    "took longer than a point may, or could no longer be the best"},
    PointStatusInfo{PointStatus::out_of_memory, "out_of_memory", "O",
                    "needed more memory than it was given"},
    PointStatusInfo{PointStatus::crashed, "crashed", "C", "ended its process"},
    PointStatusInfo{PointStatus::unsupported, "unsupported", "U",
                    "the solver does not support this problem"},
    PointStatusInfo{
        PointStatus::skipped, "skipped", "K",
        "not run: every step timed out at the neighbouring, easier point; or its calibration "
        "timed out"}};
static_assert([] {
  for (std::size_t i = 0; i < point_statuses.size(); ++i)
    if (static_cast<std::size_t>(point_statuses[i].status) != i) return false;
  return point_statuses.back().status == PointStatus::skipped;
}());

constexpr const char* to_string(PointStatus status) {
  return point_statuses[static_cast<std::size_t>(status)].name;
}

struct PointSpec {
  std::string sweep;  // "strain", "resolution" or "step"
  std::string scene;
  SceneParameters scene_parameters;  // complete
  int resolution = 0;                // the scene's own resolution parameter
  int vertices = 0, constraints = 0;
  std::string contestant = {};  // the solver, or its name where it is in a run several times
  std::string solver = {};
  Settings settings = {};  // given ones only
  double strain_limit = 0.01;
  double step = 0.01;  // s
  std::uint64_t seed = 1;

  // drape/fast_projection/n:5041/strain:0.01/h:0.004
  std::string id() const;
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
  std::vector<double> cpu_samples = {};     // of the thread in the same runs; may be empty
  std::vector<double> filter_samples = {};  // the same, spent in the inextensibility filter
  std::vector<int> sample_runs = {};        // runs that each sample is the mean of; may be empty
  int retaken = 0;                          // samples taken again because something disturbed them
  std::vector<FrameTime> frame_times = {};  // of a run of the fastest sample
};

// Times of a point that were taken on another occasion: hours later, or on another machine.
struct OccasionTime {
  double occasion;       // from 1 on: its place in the file's context.occasions
  double least, median;  // wall seconds per simulated second, of its samples
  bool operator==(const OccasionTime&) const = default;
};

// How one run went, beside its times.
struct RunOutcome {
  PointStatus status = PointStatus::ok;
  std::string detail;
  double setup_seconds = 0;
  Measures measures;

  void end(PointStatus how, std::string why) {
    status = how;
    detail = std::move(why);
  }
};

struct PointResult : Samples, RunOutcome {
  PointResult() : PointResult(PointSpec()) {}
  explicit PointResult(PointSpec what, PointStatus how = PointStatus::skipped)
      : spec(std::move(what)) {
    status = how;
  }

  PointSpec spec;
  int calibration_runs = 0;
  double calibration_guess = unknown;  // N, where the search began; unknown: at an estimate
  std::optional<double> stiffness;     // EA, N, found by calibration
  PhaseSeconds phases;                 // of the run of the first filter sample
  WorkCounters work;
  int steps_planned = 0;
  std::string linear_solver;
  double peak_rss_bytes = 0;
  bool best = false;                   // the fastest of its search, whatever its motion
  std::vector<double> best_at_errors;  // levels of error that it is the fastest within
  // For a best point: "coarsest" or "finest" where a step beyond the ladder might be better still.
  std::string at_ladder_end;
  std::vector<OccasionTime> occasions;  // that came after the one of its samples

  bool ok() const { return status == PointStatus::ok; }
  bool best_somewhere() const { return ok() && (best || !best_at_errors.empty()); }
  double seconds() const;  // the point's time: of its samples, by time_of()
  // By occasion, from 0: that of its samples. Empty: it was not timed.
  std::map<int, double> times() const;
  double measured_seconds() const;  // s that the runs of all samples took together
};

// Frame times replace the point's if there are any: they are those of a faster sample.
void append(const Samples& more, PointResult& point);

}  // namespace harness
