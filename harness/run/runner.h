// Runs one point: makes the scene and the solver, finds the solver's knob where it has one, steps,
// judges.
#pragma once

#include <functional>

#include "harness/base/interrupt.h"
#include "harness/judge/reference.h"
#include "harness/points/point.h"

namespace harness {

struct Heartbeat;

// What a point is at; a heartbeat's part.
enum class RunPart { measured, calibration };

struct RunLimits {
  double timeout = 60;      // s of wall time, for each run of a calibration and the measured one
  double hopeless = 1e300;  // s of stepping after which a run cannot be the best any more
  std::function<bool()> interrupted = nullptr;           // asked after every step
  std::shared_ptr<ReferenceShelf> references = nullptr;  // null: no errors against references
  Heartbeat* heartbeat = nullptr;                        // told of every step; see child_process.h
};

// One measured run; its time is the first sample. guess: a stiffness to begin calibration from,
// where one is needed. Throws Interrupted, and nothing else: whatever goes wrong is the point's
// status.
PointResult run_point(const PointSpec& spec, const RunLimits& limits,
                      std::optional<double> guess = {});

// Once more, for time alone: the judge stays out. Appends a sample.
void repeat_point(PointResult& point, const RunLimits& limits);

}  // namespace harness
