#include "harness/run/point_runner.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "harness/base/child_process.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/judge.h"
#include "harness/judge/mechanics.h"
#include "harness/run/calibration.h"

namespace harness {

using inextensible::State;
using inextensible::Status;

namespace {

// A run that hardly moves keeps its strain and its energy, as single precision does at tiny steps.
// Half the reference's motion is far from both ends: phase errors and damping leave more, what does
// not move leaves none.
constexpr double least_motion = 0.5;

constexpr int sampled_instants = 100;  // a run, for statistics that need sorting

// A read of the clock takes tens of nanoseconds, the step of a short chain a few hundred. So steps
// are timed in blocks of at least this length where the judge need not look in between, and a run
// whose judged steps are shorter is run again without the judge, for its time.
constexpr double shortest_block = 2e-5;  // s

// Nominal times are right within a factor of two: work that is a few times too much is hopeless.
constexpr double work_patience = 4;

constexpr double rounding = 1e-6;  // of a frame: times add up their steps

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

FrameTimes::FrameTimes(double step) {
  for (const double rate : frame_rates) {
    if (step * rate <= 1 + rounding) films_.push_back({rate, {}});
  }
}

void FrameTimes::add(int steps, double step, double time, double seconds) {
  time_ = time;
  for (Film& film : films_) {
    for (int k = 0; k < steps; ++k) {
      const double end = (time - k * step) * film.rate;  // in frames
      const auto frame = static_cast<std::size_t>(std::max(0.0, std::ceil(end - rounding) - 1));
      if (film.seconds.size() <= frame) film.seconds.resize(frame + 1, 0.0);
      film.seconds[frame] += seconds / steps;
    }
  }
}

std::vector<FrameTime> FrameTimes::summary() const {
  std::vector<FrameTime> all;
  for (const Film& film : films_) {
    std::vector<double> whole = film.seconds;
    whole.resize(static_cast<std::size_t>(time_ * film.rate + rounding));
    if (whole.empty()) continue;
    all.push_back({film.rate, quantile(whole, 0.5), quantile(whole, 0.99), quantile(whole, 1)});
  }
  return all;
}

PointRunner::PointRunner(const PointSpec& spec, const RunLimits& limits)
    : spec_(spec),
      limits_(limits),
      start_(Clock::now()),
      scene_(find_scene(spec.scene)->build(spec.scene_parameters)),
      backend_(*inextensible::find_backend(spec.solver)),
      steps_(static_cast<int>(std::lround(scene_.duration / spec.step))),
      first_state_(start_of(scene_, backend_, spec.step)) {
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

// Judges the steps of a run, and times them.
class PointRunner::RunObserver : public Observer {
 public:
  // judge: null leaves all time to the steps.
  RunObserver(const PointRunner& runner, Judge* judge, double stop_at, bool by_work, Run& run)
      : runner_(runner),
        judge_(judge),
        stop_at_(stop_at),
        by_work_(by_work),
        run_(run),
        frames_(runner.spec_.step) {}

  int before(const State& state, const DriveState& /*driven*/) {
    if (judge_) judge_->before(state, runner_.spec_.step);
    cpu_begin_ = thread_seconds();
    begin_ = Clock::now();
    return block_;
  }

  void each(const State& state, const DriveState& driven) {
    runner_.beat(driven.steps, state.time);
  }

  void all(const State& state, const DriveState& driven) {
    const double seconds = since(begin_);
    if (run_.seconds == 0) run_.first_step_seconds = seconds;
    run_.seconds += seconds;
    const double cpu_seconds = thread_seconds() - cpu_begin_;
    if (judge_) run_.cpu_seconds += cpu_seconds;
    const double time = state.time - runner_.first_state_.time;
    // Where another process had the processor, the frame is not to blame.
    if (driven.taken > 0)
      frames_.add(runner_.spec_.adaptive ? 1 : driven.taken, runner_.spec_.step, time,
                  std::min(seconds, cpu_seconds));
    if (!judge_ && seconds < shortest_block) block_ *= 2;
  }

  bool after(const State& state, const DriveState& driven) {
    if (runner_.spec_.adaptive) run_.smallest_step = driven.smallest;
    if (judge_) {
      const double strain =
          judge_->after(run_.stepper->filtered_positions(), state, driven.last, driven.whole);
      if (runner_.overstrained(strain, stop_at_, run_)) return false;
    }
    return driven.steps == runner_.steps_ || !(stepped() > runner_.limits_.hopeless);
  }

  std::vector<FrameTime> frame_times() const { return frames_.summary(); }

 private:
  // s, as far as it counts against limits_.hopeless.
  double stepped() const {
    if (!by_work_) return run_.seconds;
    return nominal_seconds(run_.stepper->work(), runner_.scene_.problem->constraints()) /
           work_patience;
  }

  const PointRunner& runner_;
  Judge* judge_;
  double stop_at_;
  bool by_work_;
  Run& run_;
  FrameTimes frames_;
  int block_ = 1;  // steps that are timed as one
  double cpu_begin_ = 0;
  Clock::time_point begin_;
};

bool PointRunner::overstrained(double strain, double stop_at, Run& run) const {
  if (backend_.strain_control == inextensible::StrainControl::none || strain <= stop_at)
    return false;
  run.status = !(strain <= diverged_strain) ? PointStatus::diverged : PointStatus::strain_missed;
  run.detail = "strain " + std::to_string(strain) + " at step " +
               std::to_string(run.stepper->work().steps - 1);
  return true;
}

void PointRunner::tell_end(const DriveState& driven, double time, Run& run) const {
  if (driven.end == DriveState::End::arrived || run.status != PointStatus::ok) return;
  if (driven.end == DriveState::End::refused) {
    run.status = driven.result.status == Status::not_finite ? PointStatus::diverged
                                                            : PointStatus::not_converged;
    run.detail = refusal(driven.result, run.stepper->work().steps, time);
    if (spec_.adaptive) run.detail += "; at the smallest step, " + number_text(driven.next) + " s";
    return;
  }
  const bool slow = driven.end == DriveState::End::stopped;
  run.status = PointStatus::timeout;
  std::ostringstream text;
  text << "longer than " << (slow ? limits_.hopeless : limits_.timeout) << " s"
       << (slow ? ", far above the best time so far" : "") << "; stopped at t = " << time << " s";
  run.detail = text.str();
}

Run PointRunner::run(const inextensible::Settings& settings, bool judged, double stop_at,
                     bool phases, bool by_work) const {
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
  State state = first_state_;
  beat(0, 0);
  RunObserver observer(*this, judge ? &*judge : nullptr, stop_at, by_work, run);
  // Between blocks there is little but reads of the clock; the judge takes longer than steps do.
  const double cpu_begin = thread_seconds();
  const DriveState driven =
      drive(*run.stepper, state, {spec_.step, steps_, spec_.adaptive ? usual_halvings : 0},
            observer, {limits_.timeout, start_, limits_.interrupted});
  if (!judged) run.cpu_seconds = thread_seconds() - cpu_begin;
  tell_end(driven, state.time, run);
  run.frame_times = observer.frame_times();
  if (judge) {
    run.stepper->observe(nullptr);
    run.measures = judge->finish();
    if (run.status == PointStatus::ok) decide(*judge, run);
  }
  return run;
}

void PointRunner::decide(const Judge& judge, Run& run) const {
  const Measures& found = run.measures;
  if (backend_.strain_control != inextensible::StrainControl::none &&
      !(found.max_strain <= spec_.strain_limit * (1 + 1e-9))) {
    run.status = PointStatus::strain_missed;
    run.detail = "maximum strain " + told_apart(found.max_strain, spec_.strain_limit) + " above " +
                 number_text(spec_.strain_limit);
  } else if (const std::string gained =
                 energy_gained(judge.energy(), scene_.energy_bound, scene_.duration);
             !gained.empty()) {
    run.status = PointStatus::energy_gained;
    run.detail = gained;
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
  State state = first_state_;
  const auto before = Clock::now();
  for (int i = 0; i < steps_; ++i) stepper->advance(state, spec_.step);
  return since(before) / steps_;
}

void PointRunner::restart_clock(RunPart part) {
  start_ = Clock::now();
  if (limits_.heartbeat) limits_.heartbeat->restart(static_cast<int>(part));
}

// Where this run is, for the process that watches over it. In whatever order it sees that.
void PointRunner::beat(long step, double time) const {
  if (!limits_.heartbeat) return;
  limits_.heartbeat->step.store(step, std::memory_order_relaxed);
  limits_.heartbeat->time.store(time, std::memory_order_relaxed);
}

double harness_seconds_per_step() {
  PointSpec spec;
  spec.scene = "chain";
  spec.scene_parameters = complete_parameters(*find_scene(spec.scene), {{"n", 2}});
  spec.solver = "null";
  spec.strain_limit = 1;
  constexpr int steps = 4096, rounds = 25;
  spec.step = spec.scene_parameters.at("duration") / steps;
  Heartbeat heartbeat;
  RunLimits limits;
  limits.interrupted = [] { return false; };
  limits.heartbeat = &heartbeat;
  const PointRunner runner(spec, limits);
  double with = 1e300, without = 1e300;
  for (int round = 0; round < rounds; ++round) {  // the least of each: what else runs only adds
    with = std::min(with, runner.seconds_per_step(runner.run({}, false, diverged_strain)));
    without = std::min(without, runner.bare_seconds_per_step());
  }
  return std::max(0.0, with - without);
}

}  // namespace harness

