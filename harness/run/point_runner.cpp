#include "harness/run/point_runner.h"

#include "harness/base/child_process.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/judge.h"
#include "harness/judge/mechanics.h"
#include "harness/run/calibration.h"
#include "harness/run/machine_noise.h"

namespace harness {
namespace {

// A run that hardly moves keeps its strain and energy, as in single precision at tiny steps. Phase
// errors and damping leave far more than half of the reference's motion.
constexpr double least_motion = 0.5;

constexpr int sampled_instants = 100;  // a run, for statistics that need sorting
constexpr double work_patience = 4;    // nominal times are right within a factor of two only
// Reading the clock takes tens of nanoseconds, the step of a short chain a few hundred: without the
// judge, steps are timed in blocks of at least this length.
constexpr double shortest_block = 2e-5;  // s

constexpr double between_looks = 0.005;  // s of stepping
constexpr double longest_pauses = 5;     // s of a run, and no longer than its steps took
constexpr double rounding = 1e-6;        // of a frame: times add up their steps

std::string refusal(const StepResult& result, std::int64_t step, double time) {
  const bool edge_known = result.worst_edge >= 0 && std::isfinite(result.worst_strain);
  return concat("step ", step, " (t = ", time, " s): ", inextensible::to_string(result.status),
                ", ", result.detail, " after ", result.iterations, " iterations") +
         (edge_known ? concat("; edge ", result.worst_edge, " strained by ", result.worst_strain)
                     : "");
}

}  // namespace

FrameTimes::FrameTimes(double step) {
  for (const double rate : frame_rates)
    if (step * rate <= 1 + rounding) films_.push_back({rate, {}});
}

void FrameTimes::add(int steps, double step, double time, double seconds) {
  time_ = time;
  for (Film& film : films_)
    for (int k = 0; k < steps; ++k) {
      const double end = (time - k * step) * film.rate;  // in frames
      const auto frame = static_cast<std::size_t>(std::max(0.0, std::ceil(end - rounding) - 1));
      if (film.seconds.size() <= frame) film.seconds.resize(frame + 1, 0.0);
      film.seconds[frame] += seconds / steps;
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
      scene_(limits.scene ? *limits.scene : find_scene(spec.scene)->build(spec.scene_parameters)),
      backend_(*find_backend(spec.solver)),
      steps_(static_cast<int>(std::lround(scene_.duration / spec.step))),
      first_state_(start_of(scene_, backend_, spec.step)) {
  if (limits.references) reference_ = limits.references->find(spec.scene, spec.scene_parameters);
}

// Times the steps of a run, judges them, and says in its status why it ended.
class PointRunner::Observed : public Observer {
 public:
  // Without the judge, all time is left to the steps.
  Observed(const PointRunner& runner, bool judged, double stop_at, RunPart part, Run& run)
      : runner_(runner), stop_at_(stop_at), part_(part), run_(run) {
    if (!judged) return;
    judge_.emplace(runner.scene_, judging());
    run.stepper->observe(judge_->observer());
    run.observed = judge_->observer() != nullptr;
  }

  int before(const State& state, const DriveState& /*driven*/) {
    if (judge_) judge_->before(state, spec_.step);
    if (limits_.timed && part_ == RunPart::measured && run_.seconds >= next_look_) pause();
    cpu_begin_ = thread_seconds();
    begin_ = Clock::now();
    return block_;
  }

  // Tells the watching process where this run is; the order in which it sees this does not matter.
  void each(const State& state, const DriveState& driven) {
    if (!limits_.heartbeat) return;
    limits_.heartbeat->step.store(driven.steps, std::memory_order_relaxed);
    limits_.heartbeat->time.store(state.time, std::memory_order_relaxed);
  }

  void all(const State& state, const DriveState& driven) {
    const double seconds = since(begin_);
    if (run_.seconds == 0) run_.first_step_seconds = seconds;
    run_.seconds += seconds;
    const std::int64_t steps = runner_.steps_, done = std::max(driven.steps - 1, 0L);
    const auto part = static_cast<std::size_t>(done * std::min(steps, Run::most_parts) / steps);
    run_.parts.resize(part + 1);  // never less than before
    run_.parts.back() += seconds;
    const double cpu_seconds = thread_seconds() - cpu_begin_;
    if (judge_) run_.cpu_seconds += cpu_seconds;
    const double time = state.time - runner_.first_state_.time;
    // Time in which another process had the processor is not the frame's.
    if (driven.taken > 0)
      frames_.add(driven.taken, spec_.step, time, std::min(seconds, cpu_seconds));
    if (!judge_ && seconds < shortest_block) block_ *= 2;
  }

  bool after(const State& state, const DriveState& driven) {
    if (judge_ && overstrained(judge_->after(run_.stepper->filtered_positions(), state, driven.last,
                                             driven.whole)))
      return false;
    return driven.steps == runner_.steps_ || !(stepped() > limits_.hopeless);
  }

  void finish(const DriveState& driven, double time) {
    if (run_.status == PointStatus::ok) tell_end(driven, time);
    run_.frame_times = frames_.summary();
    if (block_ > 1) run_.parts = {run_.seconds};
    if (!judge_) return;
    run_.stepper->observe(nullptr);
    run_.measures = judge_->finish();
    if (run_.status == PointStatus::ok) decide();
  }

  double paused() const { return paused_; }

 private:
  Judge::Options judging() const {
    Judge::Options options{runner_.steps_ / sampled_instants};
    options.velocities = backend_.velocities;
    if (stop_at_ != diverged_strain) return options;  // no errors, and nothing beside them
    options.reference = runner_.reference_;
    options.residuals = backend_.shows_iterates && spec_.sweep == "step";  // for Figure 3
    return options;
  }

  bool keeps_strain() const { return backend_.strain_control != StrainControl::none; }

  // Lets a long run go on when nobody else uses the core.
  void pause() {
    next_look_ = run_.seconds + between_looks;
    const auto start = Clock::now();
    quiet_probe().wait(std::min(run_.seconds, longest_pauses) - paused_);
    paused_ += since(start);
  }

  // Whether the strain of a step ends the run.
  bool overstrained(double strain) {
    if (!keeps_strain() || strain <= stop_at_) return false;
    run_.end(strain <= diverged_strain ? PointStatus::strain_missed : PointStatus::diverged,
             concat("strain ", strain, " at step ", run_.stepper->work().steps - 1));
    return true;
  }

  // s, as far as it counts against limits_.hopeless.
  double stepped() const {
    if (part_ == RunPart::measured) return run_.seconds;
    return nominal_seconds(run_.stepper->work(), runner_.scene_.problem->constraints()) /
           work_patience;
  }

  void tell_end(const DriveState& driven, double time) {
    using End = DriveState::End;
    if (driven.end == End::arrived) return;
    if (driven.end == End::refused) {
      const bool overflow = driven.result.status == Status::not_finite;
      return run_.end(overflow ? PointStatus::diverged : PointStatus::not_converged,
                      refusal(driven.result, run_.stepper->work().steps, time));
    }
    const bool slow = driven.end == End::stopped;
    run_.end(PointStatus::timeout, concat("longer than ", slow ? limits_.hopeless : limits_.timeout,
                                          " s", slow ? ", far above the best time so far" : "",
                                          "; stopped at t = ", time, " s"));
  }

  // Judges a run that reached its end.
  void decide() {
    const Measures& found = run_.measures;
    const Scene& scene = runner_.scene_;
    if (keeps_strain() && !(found.max_strain <= spec_.strain_limit * (1 + 1e-9)))
      return run_.end(PointStatus::strain_missed,
                      "maximum strain " + told_apart(found.max_strain, spec_.strain_limit) +
                          " above " + number_text(spec_.strain_limit));
    const std::string gained = energy_gained(judge_->energy(), scene.energy_bound, scene.duration);
    if (!gained.empty()) return run_.end(PointStatus::energy_gained, gained);
    if (const int crossed = judge_->crossings().vertices(); crossed > 0)
      return run_.end(PointStatus::body_crossed,
                      concat(crossed, " of ", scene.problem->vertices(),
                             " vertices passed through the body; shorter steps may not"));
    if (found.moved < least_motion)
      run_.end(PointStatus::motion_lost,
               concat("its vertices moved ", number_text(found.moved, 3),
                      " times as far as the reference's, ", least_motion, " are needed"));
  }

  const PointRunner& runner_;
  const PointSpec& spec_ = runner_.spec_;
  const RunLimits& limits_ = runner_.limits_;
  const Backend& backend_ = runner_.backend_;
  double stop_at_;
  RunPart part_;
  Run& run_;
  std::optional<Judge> judge_;
  FrameTimes frames_{spec_.step};
  double next_look_ = between_looks, paused_ = 0;  // s of stepping, and of looks and pauses
  int block_ = 1;                                  // steps that are timed as one
  double cpu_begin_ = 0;
  Clock::time_point begin_;
};

Run PointRunner::run(const Settings& settings, bool judged, double stop_at, bool phases,
                     RunPart part) const {
  Run run;
  const auto start = Clock::now();
  if (limits_.heartbeat) limits_.heartbeat->restart(static_cast<int>(part));
  run.stepper = make_stepper(spec_.solver, scene_.problem,
                             {spec_.strain_limit, spec_.seed, settings, &first_state_});
  run.setup_seconds = since(start);
  run.stepper->measure_phases(phases);
  State state = first_state_;
  Observed observer(*this, judged, stop_at, part, run);
  observer.each({}, {});
  // The judge can take longer than the steps; without it there are only reads of the clock between.
  const double cpu_begin = thread_seconds();
  const DriveState driven = drive(*run.stepper, state, {spec_.step, steps_, 0}, observer,
                                  {limits_.timeout, start, limits_.interrupted});
  if (!judged) run.cpu_seconds = thread_seconds() - cpu_begin - observer.paused();
  observer.finish(driven, state.time);
  return run;
}

}  // namespace harness
