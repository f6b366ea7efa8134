#include "harness/run/measure_point.h"

#include <fstream>
#include <new>
#include <numeric>

#include "harness/judge/mechanics.h"
#include "harness/run/calibration.h"
#include "harness/run/machine_noise.h"
#include "harness/run/point_runner.h"

namespace harness {
namespace {

// A shorter judged step is timed again without the judge.
constexpr double shortest_judged_step = 5e-5;  // s: four phases and the step itself are timed
constexpr double several = 2.5;                // long runs that a later sample takes
constexpr double longest_sample = 10;          // s, of such a sample
constexpr double least_filter_sample = 0.005;  // s, of a run with short steps

// Peak resident size of this process since the last reset; 0 where the system does not tell.
void reset_peak_rss() { std::ofstream("/proc/self/clear_refs") << 5; }
double peak_rss_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  return 0;
}

// Runs that make one sample, or up to the one that failed.
struct Batch {
  Run last;
  double seconds = 0, cpu_seconds = 0, filter_seconds = 0;  // of all runs
  std::vector<double> parts;                                // s, the shortest among all runs
  int runs = 0;

  bool ok() const { return last.status == PointStatus::ok; }
  // s of one run: disturbances only lengthen a run, and hardly the same part of each.
  double a_run() const { return std::accumulate(parts.begin(), parts.end(), 0.0); }
  void add(Run run) {
    last = std::move(run);
    seconds += last.seconds;
    if (runs > 0 && parts.size() == last.parts.size())
      std::ranges::transform(parts, last.parts, parts.begin(), std::ranges::min);
    else if (runs == 0 || last.seconds < a_run())
      parts = last.parts;
    cpu_seconds += last.cpu_seconds;
    filter_seconds += last.stepper->phases().filter;
    ++runs;
  }
};

bool may_be_retaken(const Batch& batch) { return batch.ok() && batch.seconds < longest_retaken; }

struct Sampler {
  const PointResult& point;  // with the previous samples
  const PointRunner& runner;
  const Settings& settings;
  // Reads of the clock would distort the time of a short step: its phases are timed in other runs.
  bool short_steps;
  const RunLimits& limits;
  Samples& taken;            // gets the samples
  PhaseSeconds phases = {};  // of the filter sample

  // Takes a sample and returns the last run, perhaps a failed one.
  Run add() {
    if (short_steps) {
      Batch in_phases = batch(least_filter_sample, true);
      if (!in_phases.ok()) return std::move(in_phases.last);
      record_filter(in_phases);
    }
    const auto take = [this] { return batch(least_sample, !short_steps); };
    const double wait = limits.timed ? limits.longest_wait : 0;
    auto [sample, dropped] =
        wait > 0 ? take_quietly(quiet_probe(), take, may_be_retaken, wait) : std::pair(take(), 0);
    taken.retaken += dropped;
    return record(std::move(sample));
  }

  Run record(Batch sample) {
    if (!sample.ok()) return std::move(sample.last);
    if (!short_steps) record_filter(sample);
    const double seconds = of_a_second(sample.seconds, sample);
    if (!(seconds >= point.seconds())) taken.frame_times = sample.last.frame_times;
    taken.samples.push_back(seconds);
    taken.cpu_samples.push_back(of_a_second(sample.cpu_seconds, sample));
    taken.sample_runs.push_back(sample.runs);
    return std::move(sample.last);
  }

  // As many runs as take at least that long together, s; of one more sample of long runs, several.
  Batch batch(double at_least, bool with_phases) {
    Batch batch;
    do {
      batch.add(runner.run(settings, false, diverged_strain, with_phases));
      if (limits.sample_of && batch.runs == 1 && batch.seconds >= longest_retaken)
        at_least = std::min(several * batch.seconds, longest_sample);
    } while (limits.timed && batch.ok() && batch.seconds < at_least);
    return batch;
  }

  void record_filter(const Batch& batch) {
    phases = batch.last.stepper->phases();
    taken.filter_samples.push_back(of_a_second(batch.filter_seconds, batch));
  }

  // seconds: of all runs of a batch. Returns those of a simulated second in its composed run.
  double of_a_second(double seconds, const Batch& batch) const {
    return seconds / batch.seconds * batch.a_run() / (runner.steps() * runner.spec().step);
  }
};

bool needs_stiffness(const PointRunner& runner) {
  return runner.backend().strain_control == StrainControl::stiffness &&
         !runner.spec().settings.contains("stiffness");
}

// Adds the stiffness that springs need to the settings. False: none, and the point says why.
bool calibrate(PointResult& point, const PointRunner& runner, Settings& settings,
               std::optional<double> guess) {
  const PointSpec& spec = point.spec;
  point.calibration_guess = guess.value_or(unknown);
  const Calibration found = calibrate_stiffness(
      spec.strain_limit, guess.value_or(first_stiffness(runner.scene(), spec.strain_limit)),
      [&](double stiffness) -> CalibrationTrial {
        settings["stiffness"] = stiffness;
        const Run run = runner.run(settings, true, calibration_cut_short * spec.strain_limit, true,
                                   RunPart::calibration);
        return {run.status, run.measures.max_strain, run.seconds, run.detail};
      });
  point.calibration_runs = found.runs;
  point.stiffness = found.stiffness;
  if (point.stiffness)
    settings["stiffness"] = *point.stiffness;
  else
    point.end(found.status, found.detail);
  return point.stiffness.has_value();
}

// The judged run, and a first sample: the same run if it is long enough, and if the judge saw no
// iterates, which are kept while the clock runs.
void measure(PointResult& point, const PointRunner& runner, const Settings& settings,
             const RunLimits& limits) {
  if (limits.timed) quiet_probe().wait(limits.longest_wait);
  Batch judged;
  judged.add(runner.run(settings, true, diverged_strain));
  static_cast<RunOutcome&>(point) = judged.last;
  point.phases = judged.last.stepper->phases();
  point.work = judged.last.stepper->work();
  point.linear_solver = judged.last.stepper->linear_solver();
  if (!point.ok()) return;
  const bool short_steps = judged.last.seconds / runner.steps() < shortest_judged_step;
  Sampler sampler{point, runner, settings, short_steps, limits, point};
  const bool a_sample =
      !judged.last.observed && !short_steps && (!limits.timed || judged.seconds >= least_sample);
  const Run last = a_sample ? sampler.record(std::move(judged)) : sampler.add();
  if (!point.filter_samples.empty()) point.phases = sampler.phases;
  point.end(last.status, last.detail);  // without a time it is not a result
}

void take_sample(PointResult& more, const RunLimits& limits) {
  const PointResult& point = *limits.sample_of;
  Settings settings = point.spec.settings;
  if (point.stiffness) settings["stiffness"] = *point.stiffness;
  const PointRunner runner(point.spec, limits);
  const bool short_steps = point.seconds() * point.spec.step < shortest_judged_step;
  Sampler{point, runner, settings, short_steps, limits, more}.add();
}

void look(PointResult& point, const RunLimits& limits) {
  const PointSpec& spec = point.spec;
  const PointRunner runner(spec, limits);
  Settings settings = spec.settings;
  const bool springs = needs_stiffness(runner);
  if (springs)
    settings["stiffness"] =
        limits.stiffness_guess.value_or(first_stiffness(runner.scene(), spec.strain_limit));
  const Run run = runner.run(settings, true, std::numeric_limits<double>::infinity());
  const auto steps = static_cast<double>(run.stepper->work().steps);
  // The first step sets up what the others use.
  if (steps > 0)
    point.samples = {
        (steps == 1 ? run.seconds : (run.seconds - run.first_step_seconds) / (steps - 1)) /
        spec.step};
  point.status = PointStatus::ok;
  if (run.status == PointStatus::not_converged || run.status == PointStatus::diverged) {
    point.end(run.status, run.detail);
  } else if (const double strain = run.measures.max_strain;
             !springs && runner.backend().strain_control != StrainControl::none &&
             !(strain <= spec.strain_limit * (1 + 1e-9))) {
    point.end(PointStatus::strain_missed, "strain " + told_apart(strain, spec.strain_limit));
  }
}

void run_whole(PointResult& point, const RunLimits& limits) {
  const PointRunner runner(point.spec, limits);
  point.steps_planned = runner.steps();
  Settings settings = point.spec.settings;
  if (!needs_stiffness(runner) || calibrate(point, runner, settings, limits.stiffness_guess))
    measure(point, runner, settings, limits);
}

}  // namespace

PointResult run_point(const PointSpec& spec, const RunLimits& limits) {
  PointResult point(spec);
  reset_peak_rss();
  try {
    if (limits.sample_of)
      take_sample(point, limits);
    else if (limits.look)
      look(point, limits);
    else
      run_whole(point, limits);
  } catch (const std::bad_alloc&) {
    point.end(PointStatus::out_of_memory, "an allocation failed");
  } catch (const std::invalid_argument& error) {  // the solver does not take the problem
    point.end(PointStatus::unsupported, error.what());
  }
  point.peak_rss_bytes = peak_rss_bytes();
  return point;
}

}  // namespace harness
