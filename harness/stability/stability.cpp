#include "harness/stability/stability.h"

#include "harness/points/schema.h"
#include "harness/stability/cases.h"

namespace harness {

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

StabilityPlan plan_stability(const std::string& profile, const std::optional<Pattern>& solver,
                             const std::optional<Pattern>& hard_case) {
  StabilityPlan plan{{}, hard_cases(profile)};
  for (const auto& backend : backends())
    if (backend.contestant && (!solver || matches(*solver, backend.name)))
      plan.solvers.emplace_back(backend.name);
  const auto selected = [&](const std::string& name) {
    return !hard_case || hard_case->found_in(name);
  };
  std::erase_if(plan.cases,
                [&](const HardCase& c) { return !selected(c.name) && !selected(c.row); });
  plan.scenes = {{"chain of 20", "chain", 20, 1.0 / 6400},
                 {"drape 11 x 11", "drape", 11, 1.0 / 3200},
                 {"patch 11 x 11", "patch", 11, 1.0 / 3200},
                 {"taut row of 30", "taut_row", 31, 1.0 / 6400}};
  std::erase_if(plan.scenes, [&](const auto& scene) {
    return !selected(std::string("largest step ") + scene.name);
  });
  plan.freedom = selected("triangles");
  const auto has = [&](const char* name) { return std::ranges::count(plan.solvers, name) > 0; };
  if (has("fast_projection") && has("icd"))
    for (const double limit : {0.01, 0.001})
      plan.frames.insert(plan.frames.end(),
                         {{"drape", 21, limit}, {"drape", 31, limit}, {"patch", 21, limit}});
  std::erase_if(plan.frames,
                [&](const auto& scene) { return !selected("same frame " + scene.name()); });
  if (plan.solvers.empty()) throw UsageError("no contestant matches --solver");
  if (plan.cases.empty() && plan.scenes.empty() && plan.frames.empty())
    throw UsageError("no case matches --case (bench list cases names them)");
  return plan;
}

StabilityOutcome run_stability(const StabilityPlan& plan, std::uint64_t seed,
                               const RunEvents& events) {
  StabilityOutcome outcome;
  const auto stop_if_asked = [&events] {
    if (events.interrupted()) throw Interrupted();
  };
  try {
    for (const HardCase& c : plan.cases) {
      for (const std::string& solver : plan.solvers) {
        stop_if_asked();
        const std::string key = cell_key(c.name, solver);
        const json result = events.once(key, [&] {
          return to_json(run_isolated_trial(c.build, solver, seed, events.interrupted));
        });
        StabilityCell cell{&c, solver, trial_result_of(result), c.expectation(solver)};
        cell.expected = acceptable(cell.expectation, solver, cell.result);
        if (!cell.expected) cell.known = known_difference(c.name, solver, cell.result);
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
      for (const int n : {11, 21, 41})
        for (const Freedom& f : degrees_of_freedom(n)) outcome.freedom.push_back(f);
    }
    for (const SameFrameScene& scene : plan.frames) {
      stop_if_asked();
      outcome.same_frames.push_back(same_frame(scene, seed));
      events.done("the same frame, " + scene.name(), 0, 0);
    }
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  return outcome;
}

// JSON has null for an unknown number.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExpectationCounts, cells, strict, two_admitted, not_as_expected,
                                   new_differences)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LargestStep, scene, solver, step, failing_step, detail)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Freedom, mesh, vertices, constraints, rank, degrees_of_freedom)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameDistances, rms, largest)

static void to_json(json& object, const SameFrame& frame) {
  object = {{"scene", frame.scene.name()},
            {"side", frame.scene.side},
            {"strain_limit", frame.scene.strain_limit},
            {"step", frame.scene.step},
            {"first_contact", frame.first_contact},
            {"times", frame.times},
            {"icd", frame.icd},
            {"stopped", frame.stopped}};
}

namespace {

json known_json() {
  json list = json::array();
  for (const KnownDifference& known : known_differences())
    for (const std::string& hard_case : known.hard_cases)
      list.push_back({{"case", hard_case},
                      {"solver", known.solver},
                      {"at_fixed_step", known.fixed},
                      {"outcome", known.outcome},
                      {"reason", known.reason},
                      {"mends", known.remedy}});
  return list;
}

}  // namespace

json stability_document(json context, const StabilityOutcome& outcome, std::uint64_t seed,
                        const std::vector<std::string>& command) {
  context["command"] = command;
  context["seed"] = seed;
  json matrix = json::array();
  for (const auto& cell : outcome.cells) {
    const auto& other = cell.expectation.other;
    json row = to_json(cell.result);
    row.update({{"row", cell.hard_case->row},
                {"case", cell.hard_case->name},
                {"what", cell.hard_case->what},
                {"solver", cell.solver},
                {"expected_at_fixed_step", cell.expectation.outcome},
                {"why", cell.expectation.why},
                {"admitted_beside", other ? json(other->outcome) : json()},
                {"why_admitted", other ? json(other->why) : json()},
                {"as_expected", cell.expected},
                {"known_difference", cell.known != nullptr}});
    matrix.push_back(std::move(row));
  }
  return {{"schema", "inextensible-stability/1"},
          {"complete", outcome.complete},
          {"context", context},
          {"legend", legend()},
          {"counts", outcome.counts()},
          {"matrix", std::move(matrix)},
          {"known_differences", known_json()},
          {"largest_steps", outcome.largest_steps},
          {"degrees_of_freedom", outcome.freedom},
          {"same_frame", outcome.same_frames}};
}

}  // namespace harness
