#include "harness/run/runner.h"

#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "harness/judge/measures.h"
#include "harness/run/calibration.h"
#include "harness/run/point_runner.h"

namespace harness {
namespace {

// A shorter judged step is timed again without the judge.
constexpr double shortest_judged_step = 5e-5;  // s: four phases and the step itself are timed

// What a strand of springs bears, in what falls to it of the forces of the scene: strain = tension
// / EA. On a falling chain the tension is a few times its weight.
constexpr double tension_over_force = 5;

// Peak resident size of this process since the last reset; 0 where the system does not tell.
void reset_peak_rss() { std::ofstream("/proc/self/clear_refs") << 5; }
double peak_rss_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  }
  return 0;
}

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

void add_filter_sample(PointResult& point, const PointRunner& runner, const Run& run) {
  if (run.status != PointStatus::ok) return;
  if (point.filter_samples.empty()) point.phases = run.stepper->phases();
  point.filter_samples.push_back(run.stepper->phases().filter / (runner.steps() * point.spec.step));
}

// One sample of the point's time and one of its filter's. `run`: with its phases timed. Reads of
// the clock between phases are part of the time of a short step: that is timed again without them.
// Returns the run that gave no sample, if one did not.
std::optional<Run> add_samples(PointResult& point, const PointRunner& runner,
                               const inextensible::Settings& settings, bool short_steps, Run run) {
  add_filter_sample(point, runner, run);
  if (short_steps) run = runner.run(settings, false, diverged_strain, false);
  if (run.status != PointStatus::ok) return run;
  if (point.samples.empty()) point.frame_times = run.frame_times;
  point.samples.push_back(runner.seconds_per_step(run) / point.spec.step);
  return std::nullopt;
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
      point.calibration_guess = guess.value_or(unknown);
      Calibration calibration(spec.strain_limit, [&](double stiffness) -> Calibration::Trial {
        settings["stiffness"] = stiffness;
        runner.restart_clock(RunPart::calibration);  // every run has the whole time-out to itself
        const Run run = runner.run(settings, true, Calibration::cut_short * spec.strain_limit);
        return {run.status, run.measures.max_strain, run.seconds, run.detail};
      });
      point.stiffness = calibration.find(
          guess.value_or(tension_over_force * runner.force_of_a_strand() / spec.strain_limit));
      point.calibration_seconds = since(begin);
      point.calibration_runs = calibration.runs();
      if (!point.stiffness) {
        point.status = calibration.status();
        point.detail = calibration.detail();
        return point;
      }
      settings["stiffness"] = *point.stiffness;
    }
    runner.restart_clock(RunPart::measured);
    Run run = runner.run(settings, true, diverged_strain);
    fill(point, run);
    // Iterates are kept while the solver's clock runs, so that an observed run's time is not its
    // own.
    if (point.ok()) {
      const bool short_steps = runner.seconds_per_step(run) < shortest_judged_step;
      if (run.observed || short_steps) {
        runner.restart_clock(RunPart::measured);  // this run has the whole time-out to itself, too
        run = runner.run(settings, false, diverged_strain);
      }
      if (auto failed = add_samples(point, runner, settings, short_steps, std::move(run))) {
        point.status = failed->status;  // without a time it is no result
        point.detail = failed->detail;
      }
    }
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
  const bool short_steps = point.median_seconds() * point.spec.step < shortest_judged_step;
  add_samples(point, runner, settings, short_steps, runner.run(settings, false, diverged_strain));
}

}  // namespace harness
