// Small runs of real solvers, and a machine whose runs are formulas, without a clock.
#pragma once

#include "harness/run/sweep.h"

namespace harness {

// A run at a limit of 1 %.
inline PointSpec spec_at(const std::string& scene, const SceneParameters& parameters,
                         const std::string& solver, double step) {
  return {.sweep = "strain",
          .scene = scene,
          .scene_parameters = complete_parameters(*find_scene(scene), parameters),
          .contestant = solver,
          .solver = solver,
          .settings = {},
          .step = step};
}

struct FakeMachine {
  std::function<double(const PointSpec&)> seconds;  // of a simulated second
  std::function<PointStatus(const PointSpec&)> status = [](const auto&) { return PointStatus::ok; };
  std::function<double(const PointSpec&)> error = nullptr;  // over the scene's size; null: unknown
  double gap = 0;                                           // of the reference
  std::function<double(const PointSpec&)> reached = nullptr;  // s; where failed runs end
  std::function<double(const PointResult&)> again = [](const PointResult& point) {
    return point.samples.front();
  };
  bool stops = false;                 // runs that are hopeless
  std::vector<PointSpec> specs = {};  // in the order of their runs
  std::vector<double> hopeless = {};  // s, from which these were
  int repetitions = 0;

  // The machine must outlive it.
  Runner runner() {
    return [this](const PointSpec& spec, const RunLimits& limits) {
      if (limits.sample_of) {
        ++repetitions;
        PointResult more(spec);
        more.samples = {again(*limits.sample_of)};
        return more;
      }
      specs.push_back(spec);
      hopeless.push_back(limits.hopeless);
      PointResult point(spec, status(spec));
      point.steps_planned = static_cast<int>(std::lround(1 / spec.step));
      if (error) {
        const double e = error(spec);
        point.measures.error_series = {{0.5, e, e, gap, gap}};
      }
      const double taken = seconds(spec);
      if (stops && point.ok() && taken > limits.hopeless) point.status = PointStatus::timeout;
      if (point.ok())
        point.samples = {taken};
      else if (reached)
        point.work.steps = std::lround(reached(spec) / spec.step);
      return point;
    };
  }

  std::vector<int> steps() const {  // as 1/n s
    std::vector<int> all;
    for (const PointSpec& spec : specs) all.push_back(static_cast<int>(std::lround(1 / spec.step)));
    return all;
  }
};

inline bool has_step(const PointSpec& spec, double n) { return std::abs(spec.step * n - 1) < 1e-9; }

// Lowest, 0.1 s, at a step of 1/n s.
inline auto parabola(double n) {
  return [n](const PointSpec& spec) { return 0.1 + 0.1 * std::pow(std::log2(spec.step * n), 2); };
}

// Each halving of the step takes that many times as long.
inline auto slowing(double factor) {
  return [factor](const PointSpec& spec) { return std::pow(factor, std::log2(0.04 / spec.step)); };
}

// Steps above 1/n s are refused.
inline auto refused_above(double n, PointStatus as = PointStatus::not_converged) {
  return [n, as](const PointSpec& spec) { return spec.step * n > 1 + 1e-9 ? as : PointStatus::ok; };
}

inline auto error_of_step(double slope) {
  return [slope](const PointSpec& spec) { return slope * spec.step; };
}

// A strain sweep of fast projection on a chain of ten.
inline Suite suite_of_chain(std::vector<double> limits) {
  Suite suite;
  suite.sweeps = {{.sweep = "strain",
                   .scene = "chain",
                   .contestants = {{"fast_projection", "fast_projection"}},
                   .limits = std::move(limits),
                   .resolutions = {10},
                   .finest = 1.0 / 6400,
                   .refine = false}};
  return suite;
}

inline SweepOutcome sweep(const Suite& suite, FakeMachine& machine) {
  return run_sweep(suite, plan(suite, {}), {}, machine.runner());
}

}  // namespace harness
