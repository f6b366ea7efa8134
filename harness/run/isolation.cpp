#include "harness/run/isolation.h"

#include "harness/base/child_process.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;
using End = ChildOutcome::End;

ChildLimits child_limits(const RunLimits& limits, double memory) {
  return {limits.timeout, memory, limits.interrupted};
}

RunLimits inside(const RunLimits& limits, Heartbeat& heartbeat) {
  RunLimits inner = limits;
  inner.interrupted = nullptr;  // the parent's business
  inner.heartbeat = &heartbeat;
  return inner;
}

std::string place(const ChildOutcome& outcome) {
  if (outcome.step < 0) return "before the first step";
  return "in step " + std::to_string(outcome.step) + " (t = " + number_text(outcome.time) + " s)";
}

// Status and detail of a point whose child did not come back.
void explain(const ChildOutcome& outcome, const RunLimits& limits, PointResult& point) {
  if (outcome.end == End::timed_out) {
    const bool calibrating = outcome.part == static_cast<int>(RunPart::calibration);
    point.status = calibrating ? PointStatus::skipped : PointStatus::timeout;
    point.detail = std::string(calibrating ? "timed out while calibrating: " : "") +
                   "longer than " + number_text(limits.timeout) + " s, stuck " + place(outcome) +
                   "; ended with " + signal_text(outcome.code);
  } else {
    const bool starved = outcome.end == End::killed && outcome.out_of_memory;
    point.status = starved ? PointStatus::out_of_memory : PointStatus::crashed;
    point.detail =
        ending(outcome) + " " + place(outcome) + (starved ? "; the kernel was out of memory" : "");
  }
  point.peak_rss_bytes = outcome.peak_rss_bytes;
}

}  // namespace

SweepRunners isolated(const SweepRunners& inner, double memory) {
  SweepRunners runners;
  runners.references = inner.references;
  runners.run = [run = inner.run, memory](const PointSpec& spec, const RunLimits& limits,
                                          std::optional<double> guess) {
    if (limits.references)  // read once, here, not in every child
      limits.references->find(spec.scene, spec.scene_parameters);
    ChildOutcome outcome = run_in_child(
        [&](Heartbeat& heartbeat) {
          return compact(to_json(run(spec, inside(limits, heartbeat), guess)));
        },
        child_limits(limits, memory));
    if (outcome.end == End::interrupted) throw Interrupted();
    if (const auto result = answer(outcome, point_of)) return *result;
    PointResult point;
    point.spec = spec;
    explain(outcome, limits, point);
    return point;
  };
  runners.repeat = [repeat = inner.repeat, memory](PointResult& point, const RunLimits& limits) {
    ChildOutcome outcome = run_in_child(
        [&](Heartbeat& heartbeat) {
          PointResult again = point;
          repeat(again, inside(limits, heartbeat));
          return compact(to_json(added_since(samples_of(point), again)));
        },
        child_limits(limits, memory));
    if (outcome.end == End::interrupted) throw Interrupted();
    if (const auto added = answer(outcome, repetition_of)) append(*added, point);
  };
  return runners;
}

}  // namespace harness
