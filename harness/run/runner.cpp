#include "harness/run/runner.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <new>
#include <sstream>

#include "harness/base/child_process.h"
#include "harness/base/clock.h"
#include "harness/base/text.h"
#include "harness/judge/judge.h"
#include "harness/judge/measures.h"
#include "inextensible/stepping/step_controller.h"

namespace harness {
namespace {

using inextensible::Status;

constexpr int sampled_instants = 100;  // a run, for statistics that need sorting

// A read of the clock takes tens of nanoseconds, the step of a short chain a few hundred. So steps
// are timed in blocks of at least this length where the judge need not look in between, and a run
// whose judged steps are shorter is made again without him, for its time.
constexpr double shortest_block = 2e-5;        // s
constexpr double shortest_judged_step = 5e-5;  // s: four phases and the step itself are timed

// Peak resident size of this process since the last reset; 0 where the system does not tell.
void reset_peak_rss() { std::ofstream("/proc/self/clear_refs") << 5; }
double peak_rss_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  }
  return 0;
}

struct Run {
  PointStatus status = PointStatus::ok;
  std::string detail;
  double seconds = 0;  // of stepping alone
  Measures measures;
  std::unique_ptr<inextensible::Stepper> stepper;
  double setup_seconds = 0;
  double smallest_step = unknown;
};

std::string refusal(const inextensible::StepResult& result, std::int64_t step, double time) {
  std::ostringstream text;
  text << "step " << step << " (t = " << time << " s): " << inextensible::to_string(result.status)
       << ", " << result.detail << " after " << result.iterations << " iterations";
  if (result.worst_edge >= 0 && std::isfinite(result.worst_strain)) {
    text << "; edge " << result.worst_edge << " strained by " << result.worst_strain;
  }
  return text.str();
}

// Scenes are the same for every run of a point; the stepper is made anew each time.
class PointRunner {
 public:
  PointRunner(const PointSpec& spec, const RunLimits& limits)
      : spec_(spec),
        limits_(limits),
        start_(Clock::now()),
        scene_(find_scene(spec.scene)->build(spec.scene_parameters)),
        backend_(*inextensible::find_backend(spec.solver)),
        steps_(static_cast<int>(std::lround(scene_.duration / spec.step))) {
    if (limits.references) reference_ = limits.references->find(spec.scene, spec.scene_parameters);
  }

  // stop_at: the run is cut short once its strain exceeds this.
  Run run(const inextensible::Settings& settings, bool judged, double stop_at) const {
    Run run;
    const auto setup = Clock::now();
    run.stepper = inextensible::make_stepper(spec_.solver, scene_.problem,
                                             {spec_.strain_limit, spec_.seed, settings});
    run.setup_seconds = since(setup);
    run.stepper->measure_phases(judged);
    Judge::Options judging{steps_ / sampled_instants};
    if (judged && stop_at == diverged_strain) {
      judging.reference = reference_;
      // Where growth is the question, a probe that needs the solver's own memory again is not.
      if (spec_.solver == "fast_projection" && !spec_.adaptive && spec_.sweep != "resolution")
        judging.residual_of_limit = spec_.strain_limit;
      // A figure draws the series of step sweeps; for the others it would fill files unread.
      judging.residual_series = spec_.sweep == "step";
    }
    Judge judge(scene_, judging);
    inextensible::State state = scene_.start;
    std::optional<inextensible::StepController> controller;
    if (spec_.adaptive) {
      controller.emplace(*run.stepper,
                         inextensible::StepController::Settings{.largest = spec_.step});
    }
    beat(0, 0);
    int block = 1;  // steps that are timed as one
    for (int i = 0; i < steps_;) {
      if (judged) judge.before(state, spec_.step);
      inextensible::StepResult result;
      bool whole = true;
      const auto before = Clock::now();
      for (int k = 0; k < block && i < steps_; ++k) {
        result = controller ? controller->advance(state) : run.stepper->advance(state, spec_.step);
        if (!result) break;
        whole = !controller || controller->aligned();
        if (whole) ++i;
        beat(i, state.time);
      }
      const double seconds = since(before);
      run.seconds += seconds;
      if (!judged && seconds < shortest_block) block *= 2;
      if (!result) {
        run.status = result.status == Status::not_finite ? PointStatus::diverged
                                                         : PointStatus::not_converged;
        run.detail = refusal(result, run.stepper->work().steps, state.time);
        if (controller)
          run.detail += "; at the smallest step, " + number_text(controller->next()) + " s";
        break;
      }
      if (controller) run.smallest_step = controller->smallest();
      if (judged) {
        const double strain = judge.after(run.stepper->filtered_positions(), state, whole);
        if (backend_.knob != inextensible::Knob::none && !(strain <= stop_at)) {
          run.status =
              !(strain <= diverged_strain) ? PointStatus::diverged : PointStatus::strain_missed;
          run.detail = "strain " + std::to_string(strain) + " at step " +
                       std::to_string(run.stepper->work().steps - 1);
          break;
        }
      }
      if (limits_.interrupted && limits_.interrupted()) throw Interrupted();
      const bool slow = run.seconds > limits_.hopeless;
      if ((slow || since(start_) > limits_.timeout) && i < steps_) {
        std::ostringstream text;
        text << "longer than " << (slow ? limits_.hopeless : limits_.timeout) << " s"
             << (slow ? ", several times the best step's time" : "")
             << "; stopped at t = " << state.time << " s";
        run.status = PointStatus::timeout;
        run.detail = text.str();
        break;
      }
    }
    run.measures = judge.measures();
    const bool missed = !(run.measures.max_strain <= spec_.strain_limit * (1 + 1e-9));
    if (judged && run.status == PointStatus::ok && missed &&
        backend_.knob != inextensible::Knob::none) {
      run.status = PointStatus::strain_missed;
      run.detail = "maximum strain " + std::to_string(run.measures.max_strain);
    }
    return run;
  }

  // The same steps with nothing around them.
  double bare_seconds_per_step() const {
    const auto stepper = inextensible::make_stepper(spec_.solver, scene_.problem,
                                                    {spec_.strain_limit, spec_.seed, {}});
    inextensible::State state = scene_.start;
    const auto before = Clock::now();
    for (int i = 0; i < steps_; ++i) stepper->advance(state, spec_.step);
    return since(before) / steps_;
  }

  void restart_clock() {
    start_ = Clock::now();
    if (limits_.heartbeat) limits_.heartbeat->restart();
  }
  bool out_of_time() const { return since(start_) > limits_.timeout; }
  const inextensible::Backend& backend() const { return backend_; }
  const PointSpec& spec() const { return spec_; }
  int steps() const { return steps_; }
  double seconds_per_step(const Run& run) const { return run.seconds / steps_; }
  double weight() const { return scene_.problem->total_mass() * scene_.problem->gravity().norm(); }

 private:
  // Where this run is, for the process that watches over it. In whatever order it sees that.
  void beat(int step, double time) const {
    if (!limits_.heartbeat) return;
    limits_.heartbeat->step.store(step, std::memory_order_relaxed);
    limits_.heartbeat->time.store(time, std::memory_order_relaxed);
  }

  const PointSpec& spec_;
  const RunLimits& limits_;
  Clock::time_point start_;
  Scene scene_;
  const inextensible::Backend& backend_;
  int steps_;
  std::shared_ptr<const Reference> reference_;
};

// Finds the stiffness EA at which the run's own maximum strain just meets the limit: Brent's method
// (GSL) on log strain / limit over log EA, bracketed from a guess. Runs far above the limit are cut
// short at twice the limit.
class Calibration {
 public:
  explicit Calibration(const PointRunner& runner) : runner_(runner) {}

  // The softest stiffness tried that met the limit; none if there is none (status() then says why).
  std::optional<double> find(double guess) {
    double soft = std::log10(guess), f_soft = excess(soft);
    double stiff = soft, f_stiff = f_soft;
    const double stride = 0.4;
    for (int i = 0; f_soft <= 0 && i < 12 && !done(f_soft) && alive(); ++i) {
      stiff = soft;
      f_stiff = f_soft;
      soft -= stride * (i + 1);
      f_soft = excess(soft);
    }
    for (int i = 0; f_stiff > 0 && i < 12 && alive(); ++i) {
      soft = stiff;
      f_soft = f_stiff;
      stiff += stride * (i + 1);
      f_stiff = excess(stiff);
    }
    if (alive() && !best_close() && f_soft > 0 && f_stiff <= 0) brent(soft, stiff);
    return best_;
  }

  int runs() const { return runs_; }
  PointStatus status() const { return status_; }
  const std::string& detail() const { return detail_; }

 private:
  static constexpr double close_enough = 0.85;  // of the limit
  static constexpr int run_limit = 16;

  static bool done(double f) { return f <= 0 && f >= std::log(close_enough); }
  bool best_close() const { return best_ && best_excess_ >= std::log(close_enough); }
  bool alive() const { return runs_ < run_limit && !runner_.out_of_time(); }

  // log(max strain / limit); a run that fails counts as far above.
  double excess(double log_stiffness) {
    const auto [known, fresh] = known_.try_emplace(log_stiffness, 0.0);
    if (fresh) known->second = evaluate(log_stiffness);
    return known->second;
  }

  double evaluate(double log_stiffness) {
    const double limit = runner_.spec().strain_limit;
    inextensible::Settings settings = runner_.spec().settings;
    settings["stiffness"] = std::pow(10, log_stiffness);
    ++runs_;
    const Run run = runner_.run(settings, true, 2 * limit);
    const bool finished = run.status == PointStatus::ok || run.status == PointStatus::strain_missed;
    if (!finished) {
      status_ = run.status;
      detail_ = "calibration, " + run.detail;
      return std::log(2.0);
    }
    const double f = std::log(std::max(run.measures.max_strain, 1e-300) / limit);
    if (f <= 0 && (!best_ || log_stiffness < std::log10(*best_))) {
      best_ = std::pow(10, log_stiffness);
      best_excess_ = f;
    }
    return f;
  }

  void brent(double soft, double stiff) {
    gsl_set_error_handler_off();
    const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
    // Aims at the middle of the band that is close enough, from the permitted side.
    gsl_function function{[](double x, void* self) {
                            return static_cast<Calibration*>(self)->excess(x) -
                                   0.5 * std::log(close_enough);
                          },
                          this};
    if (gsl_root_fsolver_set(solver.get(), &function, soft, stiff) != GSL_SUCCESS) return;
    while (alive() && !best_close()) {
      if (gsl_root_fsolver_iterate(solver.get()) != GSL_SUCCESS) return;
      if (gsl_root_fsolver_x_upper(solver.get()) - gsl_root_fsolver_x_lower(solver.get()) < 1e-3)
        return;
    }
  }

  const PointRunner& runner_;
  int runs_ = 0;
  std::map<double, double> known_;  // Brent's method asks for the bracket's ends again
  std::optional<double> best_;
  double best_excess_ = 0;
  PointStatus status_ = PointStatus::strain_missed;
  std::string detail_ = "no stiffness keeps the strain within the limit";
};

void fill(PointResult& point, Run& run) {
  point.status = run.status;
  point.detail = run.detail;
  point.setup_seconds = run.setup_seconds;
  point.measures = run.measures;
  point.smallest_step = run.smallest_step;
  point.phases = run.stepper->phases();
  point.work = run.stepper->work();
  point.linear_solver = run.stepper->linear_solver();
}

}  // namespace

PointResult run_point(const PointSpec& spec, const RunLimits& limits, std::optional<double> guess) {
  PointResult point;
  point.spec = spec;
  reset_peak_rss();
  try {
    PointRunner runner(spec, limits);
    point.steps_planned = runner.steps();
    inextensible::Settings settings = spec.settings;
    if (runner.backend().knob == inextensible::Knob::stiffness && !settings.contains("stiffness")) {
      const auto begin = Clock::now();
      Calibration calibration(runner);
      // Strain = tension / EA, and a falling chain's tension is a few times its weight.
      point.stiffness = calibration.find(guess.value_or(5 * runner.weight() / spec.strain_limit));
      point.calibration_seconds = since(begin);
      point.calibration_runs = calibration.runs();
      if (!point.stiffness) {
        point.status = calibration.status();
        point.detail = calibration.detail();
        return point;
      }
      settings["stiffness"] = *point.stiffness;
    }
    runner.restart_clock();  // the measured run has the whole time-out to itself
    Run run = runner.run(settings, true, diverged_strain);
    fill(point, run);
    if (point.ok() && runner.seconds_per_step(run) < shortest_judged_step) {
      const Run unjudged = runner.run(settings, false, diverged_strain);
      if (unjudged.status == PointStatus::ok) run.seconds = unjudged.seconds;
    }
    if (point.ok()) point.samples.push_back(runner.seconds_per_step(run) / spec.step);
  } catch (const std::bad_alloc&) {
    point.status = PointStatus::out_of_memory;
    point.detail = "an allocation failed";
  } catch (const std::invalid_argument& error) {
    point.status = PointStatus::unsupported;
    point.detail = error.what();
  }
  point.peak_rss_bytes = peak_rss_bytes();
  return point;
}

void repeat_point(PointResult& point, const RunLimits& limits) {
  inextensible::Settings settings = point.spec.settings;
  if (point.stiffness) settings["stiffness"] = *point.stiffness;
  const PointRunner runner(point.spec, limits);
  const Run run = runner.run(settings, false, diverged_strain);
  if (run.status == PointStatus::ok)
    point.samples.push_back(runner.seconds_per_step(run) / point.spec.step);
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
