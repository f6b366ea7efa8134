// Runs one point: makes the scene and the solver, finds the stiffness where the solver needs one,
// steps, judges.
#pragma once

#include <functional>

#include "harness/base/interrupt.h"
#include "harness/judge/reference.h"
#include "harness/points/point.h"

namespace harness {

struct Heartbeat;
struct Scene;

inline constexpr double least_sample = 0.02;  // s: a thousand times a block of steps
// s. Two looks of a millisecond say little of what happens in between; and what happens for
// milliseconds hardly shows.
inline constexpr double longest_retaken = 0.25;

inline constexpr double usual_look = 0.1;  // s

// What a point is at; a heartbeat's part.
enum class RunPart { measured, calibration };

struct RunLimits {
  double timeout = 60;  // s of wall time, for each run of a calibration and the measured one
  // s of stepping after which a run cannot be the best any more; of a calibration's run nominal
  // ones, so that a stiffness is found or not whatever else the machine does
  double hopeless = 1e300;
  std::function<bool()> interrupted = nullptr;            // asked after every step
  std::shared_ptr<ReferenceFolder> references = nullptr;  // null: no errors against references
  const Scene* scene = nullptr;                // the spec's, where it has been built already
  std::optional<double> stiffness_guess = {};  // N; where a calibration begins, if one is needed
  Heartbeat* heartbeat = nullptr;              // notified of every step; see child_process.h
  int most_retaken = 3;                        // times that a sample may be taken again
  bool timed = true;                           // false: times are not used, and one run is a sample
  // If it is not null, all that is wanted is one sample more of this point: the judge stays out.
  const PointResult* sample_of = nullptr;
  // true: only steps for about `hopeless` seconds. The point's one sample is their time, where one
  // step succeeded, and its status is ok if they met the strain limit. Springs have the stiffness
  // that a calibration begins with; their strain says nothing yet and counts as met.
  bool look = false;
};

// One judged run, and a first sample of its time; or only a sample more, or a look. A
// sample is the mean time of as many runs as take least_sample together; it is taken again where
// the machine was disturbed (machine_noise.h), unless it takes longer than longest_retaken. There
// is none where the run failed. Throws Interrupted, and nothing else: whatever goes wrong is the
// point's status.
PointResult run_point(const PointSpec& spec, const RunLimits& limits);

}  // namespace harness
