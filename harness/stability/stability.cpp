#include "harness/stability/stability.h"

#include <Eigen/SPQRSupport>

#include "harness/points/schema.h"

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
    for (const HardCase& c : plan.cases)
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
    for (const StabilityScene& scene : plan.scenes)
      for (const std::string& solver : plan.solvers) {
        stop_if_asked();
        outcome.largest_steps.push_back(largest_step(scene, solver, seed, events.interrupted));
        events.done("largest step, " + cell_key(scene.name, solver), 0, 0);
      }
    if (plan.freedom)
      for (const int n : {11, 21, 41})
        for (const Freedom& f : degrees_of_freedom(n)) outcome.freedom.push_back(f);
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

// ---- What is measured beside the matrix of hard cases ----

// Down the powers of two to the first step that is survived, then logarithmic bisection.
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
              built_scene(scene.type, {{"n", static_cast<double>(scene.n)}}), whole(step));
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

// Rank of the Jacobian of | d |^2 / l over all coordinates.
static int rank_of_jacobian(const Draft& mesh, int constraints, int coordinates) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < constraints; ++k) {
    const auto [a, b] = mesh.parts.edges[k];
    const Eigen::Vector3d u =
        2 * (mesh.scene.start.x.col(b) - mesh.scene.start.x.col(a)) / mesh.parts.rest_length[k];
    for (int axis = 0; axis < 3; ++axis) {
      entries.emplace_back(k, 3 * a + axis, -u[axis]);
      entries.emplace_back(k, 3 * b + axis, u[axis]);
    }
  }
  Eigen::SparseMatrix<double> jacobian(constraints, coordinates);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return static_cast<int>(Eigen::SPQR<Eigen::SparseMatrix<double>>(jacobian).rank());
}

std::vector<Freedom> degrees_of_freedom(int n) {
  std::vector<Freedom> list;
  for (auto [name, mesh] : {std::pair("quads", cases::cloth(n)),
                            {"triangles", cases::cloth(n, true)},
                            {"midpoints", cases::midpoint_cloth(n)}}) {
    std::mt19937_64 random(1);
    cases::add_noise(mesh.scene.start.x, {}, 0.2 / (n - 1), random);
    const auto edges = static_cast<int>(mesh.parts.edges.size()),
               coordinates = static_cast<int>(3 * mesh.parts.mass.size());
    const int rank = rank_of_jacobian(mesh, edges, coordinates);
    list.push_back({name, n * n, edges, rank, coordinates - rank});
  }
  return list;
}

std::string SameFrameScene::name() const {
  return concat(scene, " ", side, " x ", side, ", strain limit ", strain_limit);
}

// Compares every step until shortly after the early first contact, then at sample_interval.
SameFrame same_frame(const SameFrameScene& wanted, std::uint64_t seed) {
  constexpr double densely_until = 0.05;  // s
  const Scene scene = built_scene(wanted.scene, {{"n", wanted.side}});
  SameFrame found{.scene = wanted};
  struct Run {
    const char* solver;
    std::unique_ptr<Stepper> stepper;
    State state;
  };
  std::vector<Run> runs;
  for (const char* solver : {"fast_projection", "icd"})
    runs.push_back({solver, make_stepper(solver, scene.problem, {wanted.strain_limit, seed, {}}),
                    scene.start});
  const long steps = std::lround(scene.duration / SameFrameScene::step);
  for (long i = 1; i <= steps; ++i) {
    for (Run& run : runs) {
      const auto result = run.stepper->advance(run.state, wanted.step);
      if (result) continue;
      found.stopped =
          concat(run.solver, " at step ", i, ": ", to_string(result.status), ", ", result.detail);
      return found;
    }
    const double time = static_cast<double>(i) * wanted.step;
    if (std::isnan(found.first_contact) && runs[0].stepper->work().contacts > 0)
      found.first_contact = time;
    if (time > densely_until && std::abs(std::remainder(time, sample_interval)) > 1e-9) continue;
    found.times.push_back(time);
    found.icd.rms.push_back(rms_distance(scene, runs[0].state.x, runs[1].state.x));
    found.icd.largest.push_back(max_distance(scene, runs[0].state.x, runs[1].state.x));
  }
  return found;
}

// ---- The result file ----

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

json stability_document(json context, const StabilityOutcome& outcome, std::uint64_t seed,
                        const std::vector<std::string>& command) {
  context["command"] = command;
  context["seed"] = seed;
  json matrix = json::array(), known = json::array();
  for (const KnownDifference& one : known_differences())
    for (const std::string& hard_case : one.hard_cases)
      known.push_back({{"case", hard_case},
                       {"solver", one.solver},
                       {"at_fixed_step", one.fixed},
                       {"outcome", one.outcome},
                       {"reason", one.reason},
                       {"mends", one.remedy}});
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
          {"known_differences", std::move(known)},
          {"largest_steps", outcome.largest_steps},
          {"degrees_of_freedom", outcome.freedom},
          {"same_frame", outcome.same_frames}};
}

}  // namespace harness
