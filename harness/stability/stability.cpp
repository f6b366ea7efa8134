#include "harness/stability/stability.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/paths.h"
#include "harness/points/contestant.h"
#include "harness/stability/cases.h"
#include "solvers/registry.h"

namespace harness {
namespace {

// The largest step at which the scene's second is survived: down the powers of two to the first one
// that is, then bisection (on a logarithmic scale) against the one above.
LargestStep largest_step(const StabilityScene& scene, const std::string& solver, std::uint64_t seed,
                         const std::function<bool()>& interrupted) {
  constexpr double largest = 0.25;  // s
  constexpr int bisections = 3;  // between the first step that survives and the one above: to 9 %
  const auto whole = [](double step) { return 1 / std::round(1 / step); };  // so is a second
  LargestStep found{scene.name, solver, unknown, unknown, ""};
  const auto survives = [&](double step) {
    const TrialResult result = run_isolated_trial(
        [&] {
          Trial trial = cases::trial_of(
              cases::scene_of(scene.type, {{"n", static_cast<double>(scene.n)}}), whole(step));
          trial.timeout = trial.timeout_smaller = 2;
          return trial;
        },
        solver, seed, interrupted);
    if (result.fixed != Outcome::survived)
      found.detail = to_string(result.fixed) + (": " + result.detail);
    return result.fixed == Outcome::survived;
  };
  double high = unknown, low = largest;
  const double smallest = scene.smallest * (1 - 1e-9);
  while (low >= smallest && !survives(low)) {
    high = low;
    low /= 2;
  }
  if (low < smallest) {
    found.failing_step = high;
    return found;
  }
  for (int i = 0; i < bisections && std::isfinite(high); ++i) {
    const double middle = std::sqrt(low * high);
    (survives(middle) ? low : high) = middle;
  }
  found.step = whole(low);
  if (std::isfinite(high)) found.failing_step = whole(high);
  return found;
}

}  // namespace

bool acceptable(const Expectation& expectation, const std::string& solver,
                const TrialResult& result) {
  const auto expected = [&](Outcome outcome) {
    return expectation.outcome == outcome ||
           (expectation.other && expectation.other->outcome == outcome);
  };
  const auto gave_up = [](Outcome outcome) {
    return outcome == Outcome::refused || outcome == Outcome::timeout;
  };
  const bool stranger = !inextensible::is_built_in(solver) && expected(Outcome::survived);
  return (expected(result.fixed) || (stranger && gave_up(result.fixed))) &&
         (result.outcome == result.fixed || result.outcome == Outcome::survived_smaller ||
          gave_up(result.outcome));
}

ExpectationCounts StabilityOutcome::counts() const {
  ExpectationCounts c;
  for (const StabilityCell& cell : cells) {
    ++c.cells;
    ++(cell.expectation.other ? c.two_admitted : c.strict);
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
  plan.scenes = {{"chain of 20", "chain", 20, 1.0 / 6400},
                 {"drape 11 x 11", "drape", 11, 1.0 / 3200},
                 {"patch 11 x 11", "patch", 11, 1.0 / 3200},
                 {"taut row of 30", "taut_row", 31, 1.0 / 6400}};
  std::erase_if(plan.scenes, [&](const auto& scene) {
    return !selected(std::string("largest step ") + scene.name);
  });
  plan.freedom = selected("triangles");
  const auto has = [&](const char* name) { return std::ranges::count(plan.solvers, name) > 0; };
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
void run_plan(const StabilityPlan& plan, std::uint64_t seed, const RunEvents& events,
              StabilityOutcome& outcome) {
  const auto stop_if_asked = [&events] {
    if (events.interrupted()) throw Interrupted();
  };
  for (const HardCase* c : plan.cases) {
    for (const std::string& solver : plan.solvers) {
      stop_if_asked();
      const std::string key = cell_key(c->name, solver);
      StabilityCell cell{
          c, solver,
          trial_result_of(events.once(key,
                                      [&] {
                                        return to_json(run_isolated_trial(c->build, solver, seed,
                                                                          events.interrupted));
                                      })),
          c->expectation(solver)};
      cell.expected = acceptable(cell.expectation, solver, cell.result);
      if (!cell.expected) cell.known = known_difference(c->name, solver, cell.result);
      outcome.cells.push_back(std::move(cell));
      events.done(key, outcome.cells.size(), plan.cells());
    }
  }
  for (const StabilityScene& scene : plan.scenes) {
    for (const std::string& solver : plan.solvers) {
      stop_if_asked();
      outcome.largest_steps.push_back(largest_step(scene, solver, seed, events.interrupted));
      events.done("largest step, " + cell_key(scene.name, solver), 0, 0);
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
    events.done("the same frame, " + scene.name(), 0, 0);
  }
}

}  // namespace

StabilityOutcome run_stability(const StabilityPlan& plan, std::uint64_t seed,
                               const RunEvents& events) {
  StabilityOutcome outcome;
  try {
    run_plan(plan, seed, events, outcome);
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  return outcome;
}

}  // namespace harness
