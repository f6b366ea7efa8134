#include "harness/run/point_runner.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "harness/base/child_process.h"
#include "harness/base/text.h"
#include "harness/judge/judge.h"
#include "harness/judge/measures.h"
#include "harness/run/frame_times.h"
#include "solvers/stepping/step_controller.h"
#include "solvers/systems/constrained_acceleration.h"

namespace harness {

using inextensible::Status;

namespace {

// A run that hardly moves keeps its strain and its energy, as single precision does at tiny steps.
// Half the reference's motion is far from both ends: phase errors and damping leave more, what does
// not move leaves none.
constexpr double least_motion = 0.5;

constexpr int sampled_instants = 100;  // a run, for statistics that need sorting

// A read of the clock takes tens of nanoseconds, the step of a short chain a few hundred. So steps
// are timed in blocks of at least this length where the judge need not look in between, and a run
// whose judged steps are shorter is made again without him, for its time.
constexpr double shortest_block = 2e-5;  // s

std::string refusal(const inextensible::StepResult& result, std::int64_t step, double time) {
  std::ostringstream text;
  text << "step " << step << " (t = " << time << " s): " << inextensible::to_string(result.status)
       << ", " << result.detail << " after " << result.iterations << " iterations";
  if (result.worst_edge >= 0 && std::isfinite(result.worst_strain)) {
    text << "; edge " << result.worst_edge << " strained by " << result.worst_strain;
  }
  return text.str();
}

}  // namespace

PointRunner::PointRunner(const PointSpec& spec, const RunLimits& limits)
    : spec_(spec),
      limits_(limits),
      start_(Clock::now()),
      scene_(find_scene(spec.scene)->build(spec.scene_parameters)),
      backend_(*inextensible::find_backend(spec.solver)),
      steps_(static_cast<int>(std::lround(scene_.duration / spec.step))),
      first_state_(scene_.start) {
  if (scene_.staggered && backend_.velocities == inextensible::Velocities::half_step)
    first_state_ = inextensible::start_half_step_back(*scene_.problem, first_state_, spec.step);
  if (limits.references) reference_ = limits.references->find(spec.scene, spec.scene_parameters);
}

Judge::Options PointRunner::judging(bool errors) const {
  Judge::Options options{steps_ / sampled_instants};
  options.velocities = backend_.velocities;
  if (errors) {
    options.reference = reference_;
    // Where growth is the question, memory for iterates would be part of the answer.
    options.residual = backend_.shows_iterates && !spec_.adaptive && spec_.sweep != "resolution";
    // A figure draws the series of step sweeps; for the others it would fill files unread.
    options.residual_series = spec_.sweep == "step";
  }
  return options;
}

bool PointRunner::timed_out(double time, Run& run) const {
  const bool slow = run.seconds > limits_.hopeless;
  if (!slow && !(since(start_) > limits_.timeout)) return false;
  std::ostringstream text;
  text << "longer than " << (slow ? limits_.hopeless : limits_.timeout) << " s"
       << (slow ? ", far above the best time so far" : "") << "; stopped at t = " << time << " s";
  run.status = PointStatus::timeout;
  run.detail = text.str();
  return true;
}

void PointRunner::refuse(const inextensible::StepResult& result, double time, Run& run) {
  run.status =
      result.status == Status::not_finite ? PointStatus::diverged : PointStatus::not_converged;
  run.detail = refusal(result, run.stepper->work().steps, time);
}

bool PointRunner::overstrained(double strain, double stop_at, Run& run) const {
  if (backend_.knob == inextensible::Knob::none || strain <= stop_at) return false;
  run.status = !(strain <= diverged_strain) ? PointStatus::diverged : PointStatus::strain_missed;
  run.detail = "strain " + std::to_string(strain) + " at step " +
               std::to_string(run.stepper->work().steps - 1);
  return true;
}

Run PointRunner::run(const inextensible::Settings& settings, bool judged, double stop_at,
                     bool phases) const {
  Run run;
  const auto setup = Clock::now();
  run.stepper = inextensible::make_stepper(
      spec_.solver, scene_.problem, {spec_.strain_limit, spec_.seed, settings, &first_state_});
  run.setup_seconds = since(setup);
  run.stepper->measure_phases(phases);
  std::optional<Judge> judge;
  if (judged) {
    judge.emplace(scene_, judging(stop_at == diverged_strain));
    run.stepper->observe(judge->observer());
    run.observed = judge->observer() != nullptr;
  }
  inextensible::State state = first_state_;
  std::optional<inextensible::StepController> controller;
  if (spec_.adaptive)
    controller.emplace(*run.stepper, inextensible::StepController::Settings{.largest = spec_.step});
  beat(0, 0);
  FrameTimes frames(spec_.step);
  int block = 1;  // steps that are timed as one
  // Between blocks there is little but reads of the clock; the judge takes longer than steps do.
  const double cpu_begin = thread_seconds();
  for (int i = 0; i < steps_;) {
    if (judge) judge->before(state, spec_.step);
    inextensible::StepResult result;
    bool whole = true;
    int taken = 0;
    const double cpu_before = judged ? thread_seconds() : cpu_begin;
    const auto before = Clock::now();
    for (int k = 0; k < block && i < steps_; ++k, ++taken) {
      result = controller ? controller->advance(state) : run.stepper->advance(state, spec_.step);
      if (!result) break;
      whole = !controller || controller->aligned();
      if (whole) ++i;
      beat(i, state.time);
    }
    const double seconds = since(before);
    run.seconds += seconds;
    if (judged) run.cpu_seconds += thread_seconds() - cpu_before;
    if (taken > 0)
      frames.add(controller ? 1 : taken, spec_.step, state.time - first_state_.time, seconds);
    if (!judged && seconds < shortest_block) block *= 2;
    if (!result) {
      refuse(result, state.time, run);
      if (controller)
        run.detail += "; at the smallest step, " + number_text(controller->next()) + " s";
      break;
    }
    if (controller) run.smallest_step = controller->smallest();
    if (judge) {
      const double strain = judge->after(run.stepper->filtered_positions(), state,
                                         controller ? controller->last() : spec_.step, whole);
      if (overstrained(strain, stop_at, run)) break;
    }
    if (limits_.interrupted && limits_.interrupted()) throw Interrupted();
    if (i < steps_ && timed_out(state.time, run)) break;
  }
  if (!judged) run.cpu_seconds = thread_seconds() - cpu_begin;
  run.frame_times = frames.summary();
  if (judge) {
    run.stepper->observe(nullptr);
    run.measures = judge->finish();
    if (run.status == PointStatus::ok) decide(*judge, run);
  }
  return run;
}

void PointRunner::decide(const Judge& judge, Run& run) const {
  const Measures& found = run.measures;
  const EnergyRecord& energy = judge.energy();
  if (backend_.knob != inextensible::Knob::none &&
      !(found.max_strain <= spec_.strain_limit * (1 + 1e-9))) {
    run.status = PointStatus::strain_missed;
    run.detail = "maximum strain " + told_apart(found.max_strain, spec_.strain_limit) + " above " +
                 number_text(spec_.strain_limit);
  } else if (energy.gain() > scene_.energy_bound) {
    run.status = PointStatus::energy_gained;
    run.detail = "energy " + number_text(energy.gain(), 3) +
                 " of weight times size above the start's at step " +
                 std::to_string(energy.gain_step()) +
                 " (t = " + number_text(energy.gain_time(), 4) + " s), permitted are " +
                 number_text(scene_.energy_bound);
  } else if (const double seconds = std::max(1.0, scene_.duration);
             found.energy_rise > scene_.energy_bound * seconds) {
    run.status = PointStatus::energy_gained;
    run.detail = "energy rose by " + number_text(found.energy_rise, 3) +
                 " of weight times size in all, where it can only fall; permitted are " +
                 number_text(scene_.energy_bound * seconds);
  } else if (found.moved < least_motion) {
    run.status = PointStatus::motion_lost;
    run.detail = "its vertices moved " + number_text(found.moved, 3) +
                 " times as far as the reference's, " + number_text(least_motion) + " are needed";
  } else if (kinetic_energy_lost(found.kinetic_ratio, found.kinetic_spread)) {
    run.status = PointStatus::motion_lost;
    run.detail = "its mean kinetic energy is " + number_text(found.kinetic_ratio, 3) +
                 " times that of the ensemble, permitted are " + number_text(least_kinetic_ratio) +
                 " to " + number_text(largest_kinetic_ratio) + " and what the ensemble's runs have";
  }
}

double PointRunner::bare_seconds_per_step() const {
  const auto stepper = inextensible::make_stepper(
      spec_.solver, scene_.problem, {spec_.strain_limit, spec_.seed, {}, &first_state_});
  inextensible::State state = first_state_;
  const auto before = Clock::now();
  for (int i = 0; i < steps_; ++i) stepper->advance(state, spec_.step);
  return since(before) / steps_;
}

double PointRunner::force_of_a_strand() const {
  double length = 0;
  for (const double l : scene_.problem->rest_length()) length += l;
  const double strands = std::max(1.0, std::round(length / scene_.size));
  return energy_scale(scene_) / scene_.size / strands;
}

void PointRunner::restart_clock(RunPart part) {
  start_ = Clock::now();
  if (limits_.heartbeat) limits_.heartbeat->restart(static_cast<int>(part));
}

// Where this run is, for the process that watches over it. In whatever order it sees that.
void PointRunner::beat(int step, double time) const {
  if (!limits_.heartbeat) return;
  limits_.heartbeat->step.store(step, std::memory_order_relaxed);
  limits_.heartbeat->time.store(time, std::memory_order_relaxed);
}

}  // namespace harness
