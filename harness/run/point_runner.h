// The run of one point's scene by its solver, once or several times.
#pragma once

#include "harness/run/measure_point.h"

namespace harness {

// Divides a run's wall time into the frames of a film or game.
class FrameTimes {
 public:
  // step: s; frames that are shorter than it are left out.
  explicit FrameTimes(double step);

  // `steps` equal steps that ended at `time` (s, of the scene) took `seconds` of wall time in
  // total. A step belongs to the frame in which it ends.
  void add(int steps, double step, double time, double seconds);

  // Times of whole frames; rates without any are left out.
  std::vector<FrameTime> summary() const;

 private:
  struct Film {
    double rate;                  // frames a second
    std::vector<double> seconds;  // wall time of each frame so far
  };
  std::vector<Film> films_;
  double time_ = 0;  // s, simulated so far
};

struct Run : RunOutcome {
  static constexpr std::int64_t most_parts = 100;

  double seconds = 0;  // of stepping alone
  // s of up to `most_parts` equal parts of the run; one if its steps are so short that several of
  // them are timed as one.
  std::vector<double> parts;
  double first_step_seconds = 0;
  double cpu_seconds = 0;  // of the thread, the same
  std::unique_ptr<Stepper> stepper;
  bool observed = false;  // the judge saw the iterates
  std::vector<FrameTime> frame_times;
};

// All runs of a point share the scene; each constructs its own stepper.
class PointRunner {
 public:
  // Both must outlive this. Throws std::invalid_argument for a scene that makes no problem.
  PointRunner(const PointSpec& spec, const RunLimits& limits);

  // A run with the whole time-out to itself. judged: with the judge, whose looks are not timed. The
  // run is cut short once its strain exceeds stop_at; the errors against a reference are measured
  // only where that is diverged_strain. phases: whether they are timed, which takes tens of
  // nanoseconds each. A calibration's run is hopeless by the nominal time of its work, so that it
  // always ends alike. Throws Interrupted.
  Run run(const Settings& settings, bool judged, double stop_at, bool phases = true,
          RunPart part = RunPart::measured) const;

  const Backend& backend() const { return backend_; }
  const PointSpec& spec() const { return spec_; }
  const Scene& scene() const { return scene_; }
  int steps() const { return steps_; }

 private:
  class Observed;  // a run in progress

  const PointSpec& spec_;
  const RunLimits& limits_;
  Scene scene_;
  const Backend& backend_;
  int steps_;
  State first_state_;  // the scene's, or half a step back where velocities ask for it
  std::shared_ptr<const Reference> reference_;
};

}  // namespace harness
