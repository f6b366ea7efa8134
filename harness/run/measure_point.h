// Runs one point: makes scene and solver, finds the stiffness of springs, steps, judges.
#pragma once

#include "harness/base/clock.h"
#include "harness/judge/reference.h"
#include "harness/points/point.h"

namespace harness {

struct Heartbeat;
struct Scene;

inline constexpr double least_sample = 0.02;  // s: a thousand times a block of steps
// s. Looks before and after a longer sample say little about the time between.
inline constexpr double longest_retaken = 0.25;

inline constexpr double usual_look = 0.1;  // s

enum class RunPart { measured, calibration };

struct RunLimits {
  double timeout = 60;  // s of wall time, for each run of a calibration and the measured one
  // s of stepping after which a run cannot be the best any more. A calibration's run counts nominal
  // seconds, so that its result does not depend on what else the machine does.
  double hopeless = 1e300;
  std::function<bool()> interrupted = nullptr;            // asked after every step
  std::shared_ptr<ReferenceFolder> references = nullptr;  // null: no errors against references
  const Scene* scene = nullptr;                // the spec's, where it has been built already
  std::optional<double> stiffness_guess = {};  // N; where a calibration begins, if one is needed
  Heartbeat* heartbeat = nullptr;              // notified of every step; see child_process.h
  double longest_wait = 0.5;  // s, for a quiet core before a sample; 0: it is taken as it comes
  bool timed = true;          // false: times are not used, and one run is a sample
  // Not null: only one more sample of this point is taken, without the judge.
  const PointResult* sample_of = nullptr;
  // true: steps for about `hopeless` seconds only. Their time is the point's one sample if a step
  // succeeded, and the status is ok if they met the strain limit. Springs have the stiffness that a
  // calibration begins with, so their strain does not count.
  bool look = false;
};

// One judged run and a first sample of its time; or only one more sample, or a look. A sample is
// composed of as many runs as take least_sample together, and later ones of up to three runs above
// longest_retaken: each part of the run counts with its shortest time. It is taken again if the
// machine was disturbed (machine_noise.h) and it is not longer than longest_retaken. A run that
// failed has none. Throws only Interrupted: any other failure is the point's status.
PointResult run_point(const PointSpec& spec, const RunLimits& limits);

}  // namespace harness
