#include "harness/stability/stability.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/points/contestant.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/trial.h"
#include "solvers/registry.h"

namespace harness {
namespace {

constexpr int bisections = 3;  // between the first step that survives and the one above: to 9 %

const Expectation& expectation_of(const HardCase& hard_case, const std::string& solver) {
  return *std::find_if(hard_case.expectations.begin(), hard_case.expectations.end(),
                       [&](const Expectation& e) { return e.solvers.contains(solver); });
}

// The largest step at which the scene's second is survived: down the powers of two to the first one
// that is, then bisection (on a logarithmic scale) against the one above.
LargestStep largest_step(const StabilityScene& scene, const std::string& solver, std::uint64_t seed,
                         const std::function<bool()>& interrupted) {
  LargestStep found{scene.name, solver, unknown, unknown, ""};
  const auto survives = [&](double step) {
    const TrialResult result = run_isolated_trial(
        [&] {
          // Whole steps, so that a second is a second.
          Trial trial = scene.build(1 / std::round(1 / step));
          trial.timeout = trial.timeout_smaller = 2;
          return trial;
        },
        solver, seed, interrupted);
    if (result.fixed != Outcome::survived)
      found.detail = to_string(result.fixed) + (": " + result.detail);
    return result.fixed == Outcome::survived;
  };
  double high = unknown, low = scene.largest;
  while (low >= scene.smallest * (1 - 1e-9) && !survives(low)) {
    high = low;
    low /= 2;
  }
  if (low < scene.smallest * (1 - 1e-9)) {
    found.failing = high;
    return found;
  }
  for (int i = 0; i < bisections && std::isfinite(high); ++i) {
    const double middle = std::sqrt(low * high);
    (survives(middle) ? low : high) = middle;
  }
  found.step = 1 / std::round(1 / low);
  if (std::isfinite(high)) found.failing = 1 / std::round(1 / high);
  return found;
}

}  // namespace

bool acceptable(const Expectation& expectation, const std::string& solver,
                const TrialResult& result) {
  const bool stranger = !inextensible::is_built_in(solver) &&
                        (expectation.outcome == Outcome::survived ||
                         (expectation.other && expectation.other->outcome == Outcome::survived));
  const bool fixed =
      result.fixed == expectation.outcome ||
      (expectation.other && result.fixed == expectation.other->outcome) ||
      (stranger && (result.fixed == Outcome::refused || result.fixed == Outcome::timeout));
  return fixed && (result.outcome == result.fixed || result.outcome == Outcome::survived_smaller ||
                   result.outcome == Outcome::refused || result.outcome == Outcome::timeout);
}

ExpectationCounts StabilityOutcome::counts() const {
  ExpectationCounts c;
  for (const StabilityCell& cell : cells) {
    ++c.cells;
    ++(cell.strict() ? c.strict : c.two_admitted);
    c.not_as_expected += cell.expected ? 0 : 1;
    c.new_differences += cell.expected || cell.known ? 0 : 1;
  }
  return c;
}

StabilityPlan plan_stability(const std::vector<HardCase>& cases, const StabilityFilters& filters) {
  StabilityPlan plan;
  for (const auto& backend : inextensible::backends()) {
    if (backend.contestant && (!filters.solver || matches(*filters.solver, backend.name)))
      plan.solvers.emplace_back(backend.name);
  }
  const auto selected = [&](const std::string& name) {
    return (!filters.hard_case || filters.hard_case->found_in(name)) &&
           !(filters.but_case && filters.but_case->found_in(name));
  };
  for (const HardCase& c : cases) {
    if (selected(c.name) || selected(c.row)) plan.cases.push_back(&c);
  }
  plan.scenes = stability_scenes();
  std::erase_if(plan.scenes,
                [&](const auto& scene) { return !selected("largest step " + scene.name); });
  plan.freedom = selected("triangles");
  const auto has = [&](const char* name) {
    return std::find(plan.solvers.begin(), plan.solvers.end(), name) != plan.solvers.end();
  };
  if (has("fast_projection") && has("icd")) plan.frames = same_frame_scenes();
  std::erase_if(plan.frames,
                [&](const auto& scene) { return !selected("same frame " + scene.name()); });
  if (plan.solvers.empty()) throw UsageError("no contestant matches --solver");
  if (plan.cases.empty() && plan.scenes.empty() && plan.frames.empty())
    throw UsageError("no case matches --case (bench list cases names them)");
  return plan;
}

void StabilityPlan::keep(const Shard& part) {
  part.keep(cases);
  part.keep(scenes);
  part.keep(frames);
  freedom = freedom && part.index == 1;
}

namespace {

// Throws Interrupted, with what there is so far.
void run_plan(const StabilityPlan& plan, std::uint64_t seed, const StabilityEvents& events,
              StabilityOutcome& outcome) {
  const auto stop_if_asked = [&events] {
    if (events.interrupted()) throw Interrupted();
  };
  for (const HardCase* c : plan.cases) {
    for (const std::string& solver : plan.solvers) {
      stop_if_asked();
      const auto known = events.known(*c, solver);
      StabilityCell cell{
          c, solver,
          known ? *known : run_isolated_trial(c->build, solver, seed, events.interrupted),
          &expectation_of(*c, solver)};
      cell.expected = acceptable(*cell.expectation, solver, cell.result);
      if (!cell.expected) cell.known = known_difference(c->name, solver, cell.result);
      outcome.cells.push_back(std::move(cell));
      events.cell(outcome.cells.back(), outcome.cells.size(), plan.cells());
    }
  }
  for (const StabilityScene& scene : plan.scenes) {
    for (const std::string& solver : plan.solvers) {
      stop_if_asked();
      outcome.largest_steps.push_back(largest_step(scene, solver, seed, events.interrupted));
      events.largest_step(outcome.largest_steps.back());
    }
  }
  if (plan.freedom) {
    for (const int n : {11, 21, 41}) {
      for (const Freedom& f : degrees_of_freedom(n)) outcome.freedom.push_back(f);
    }
  }
  ReferenceFolder references(source_path("results/references"));
  for (const SameFrameScene& scene : plan.frames) {
    stop_if_asked();
    outcome.same_frames.push_back(same_frame(scene, seed, references));
    events.same_frame(outcome.same_frames.back());
  }
}

}  // namespace

StabilityOutcome run_stability(const StabilityPlan& plan, std::uint64_t seed,
                               const StabilityEvents& events) {
  StabilityOutcome outcome;
  try {
    run_plan(plan, seed, events, outcome);
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  return outcome;
}

std::vector<StabilityScene> stability_scenes() {
  const auto scene = [](const char* name, const SceneParameters& given) {
    return
        [=](double step) { return case_parts::trial_of(case_parts::scene_of(name, given), step); };
  };
  return {{"chain of 20", scene("chain", {{"n", 20}}), 0.25, 1.0 / 6400},
          {"drape 11 x 11", scene("drape", {{"n", 11}}), 0.25, 1.0 / 3200},
          {"patch 11 x 11", scene("patch", {{"n", 11}}), 0.25, 1.0 / 3200},
          {"taut row of 30", scene("taut_row", {{"n", 31}}), 0.25, 1.0 / 6400}};
}

}  // namespace harness
