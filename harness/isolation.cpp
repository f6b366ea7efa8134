#include "isolation.h"

#include "child_process.h"
#include "point_json.h"
#include "text.h"

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

// What became of a child that ended by itself, or was ended by others, without a result.
std::string ending(const ChildOutcome& outcome) {
  if (outcome.end == End::killed) return "killed by " + signal_text(outcome.code);
  if (outcome.end == End::exited) return "ended with exit code " + std::to_string(outcome.code);
  return outcome.text;  // of the exception
}

// Status and detail of a point whose child did not come back.
void explain(const ChildOutcome& outcome, const RunLimits& limits, PointResult& point) {
  if (outcome.end == End::timed_out) {
    point.status = PointStatus::timeout;
    point.detail = "longer than " + number_text(limits.timeout) + " s, stuck " + place(outcome) +
                   "; ended with " + signal_text(outcome.code);
  } else {
    const bool starved = outcome.end == End::killed && outcome.out_of_memory;
    point.status = starved ? PointStatus::out_of_memory : PointStatus::crashed;
    point.detail =
        ending(outcome) + " " + place(outcome) + (starved ? "; the kernel was out of memory" : "");
  }
  point.peak_rss_bytes = outcome.peak_rss_bytes;
}

// ---- Trials, to the parent and back ----

json pack(const TrialResult& r) {
  return {{"fixed", static_cast<int>(r.fixed)},
          {"outcome", static_cast<int>(r.outcome)},
          {"detail", r.detail},
          {"smallest_step", number(r.smallest_step)},
          {"max_strain", number(r.max_strain)},
          {"energy_gain", number(r.energy_gain)},
          {"momentum_defect", number(r.momentum_defect)},
          {"reciprocal_condition", number(r.reciprocal_condition)},
          {"seconds", r.seconds},
          {"work", to_json(r.work)}};
}

TrialResult unpack(const json& j) {
  TrialResult r;
  r.fixed = static_cast<Outcome>(j.at("fixed").get<int>());
  r.outcome = static_cast<Outcome>(j.at("outcome").get<int>());
  j.at("detail").get_to(r.detail);
  r.smallest_step = number_of(j.at("smallest_step"));
  r.max_strain = number_of(j.at("max_strain"));
  r.energy_gain = number_of(j.at("energy_gain"));
  r.momentum_defect = number_of(j.at("momentum_defect"));
  r.reciprocal_condition = number_of(j.at("reciprocal_condition"));
  j.at("seconds").get_to(r.seconds);
  r.work = work_of(j.at("work"));
  return r;
}

// A trial looks at its own clock between steps; this is for steps that do not end.
constexpr double longest_trial = 150;  // s, both attempts

}  // namespace

SweepRunners isolated(const SweepRunners& inner, double memory) {
  SweepRunners runners;
  runners.references = inner.references;
  runners.run = [run = inner.run, memory](const PointSpec& spec, const RunLimits& limits,
                                          std::optional<double> guess) {
    if (limits.references)  // read once, here, not in every child
      limits.references->find(spec.scene, spec.scene_parameters);
    const ChildOutcome outcome = run_in_child(
        [&](Heartbeat& heartbeat) {
          return to_json(run(spec, inside(limits, heartbeat), guess)).dump();
        },
        child_limits(limits, memory));
    if (outcome.end == End::interrupted) throw Interrupted();
    if (outcome.end == End::returned) return point_of(json::parse(outcome.text));
    PointResult point;
    point.spec = spec;
    explain(outcome, limits, point);
    return point;
  };
  runners.repeat = [repeat = inner.repeat, memory](PointResult& point, const RunLimits& limits) {
    const std::size_t before = point.samples.size();
    const ChildOutcome outcome = run_in_child(
        [&](Heartbeat& heartbeat) {
          PointResult again = point;
          repeat(again, inside(limits, heartbeat));
          again.samples.erase(again.samples.begin(),
                              again.samples.begin() + static_cast<std::ptrdiff_t>(before));
          return json(again.samples).dump();
        },
        child_limits(limits, memory));
    if (outcome.end == End::interrupted) throw Interrupted();
    if (outcome.end != End::returned) return;  // no sample more
    for (const double sample : json::parse(outcome.text).get<std::vector<double>>())
      point.samples.push_back(sample);
  };
  return runners;
}

TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed) {
  const ChildOutcome child =
      run_in_child([&](Heartbeat&) { return pack(run_trial(build, solver, seed)).dump(); },
                   {longest_trial, 0, nullptr});
  if (child.end == End::returned) return unpack(json::parse(child.text));
  TrialResult result;
  const bool stuck = child.end == End::timed_out;
  result.fixed = result.outcome = stuck ? Outcome::timeout : Outcome::crashed;
  result.detail =
      stuck ? "a step did not end within " + number_text(longest_trial) + " s" : ending(child);
  return result;
}

}  // namespace harness
