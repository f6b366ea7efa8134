#include "harness/stability/conformance.h"

#include "harness/base/child_process.h"
#include "harness/scenes/pendulum.h"
#include "harness/stability/stability.h"

namespace harness {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, grade, check, measured, advice)

namespace {

using Findings = std::vector<Finding>;
using Grade = Finding::Grade;

struct Examinee {
  const Backend& backend;
  const ConformanceOptions& options;
};

struct NotTaken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Some steps of one scene, judged as those of a hard case are; not their energy.
struct Case : Trial {
  std::string name;
};

Case case_of(std::string name, Scene scene, double h, int steps, double limit = 0.01) {
  return {{.scene = std::move(scene),
           .step = h,
           .steps = steps,
           .strain_limit = limit,
           .energy_tolerance = -1},
          std::move(name)};
}

// All parts joined, numbers with three digits.
template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  stream.precision(3);
  (stream << ... << parts);
  return stream.str();
}

// What a check says; `advice` is kept for a failure only.
Finding judged(bool passed, const std::string& check, const std::string& measured,
               const std::string& advice) {
  return {passed ? Grade::pass : Grade::fail, check, measured, passed ? "" : advice};
}

Finding not_applicable(const std::string& check, const std::string& why) {
  return {Grade::not_applicable, check, why, ""};
}

// A crumpled net of n x n vertices about 1 m apart, masses over a decade, weightless; the first
// `pins` are pinned; speeds up to `speed` m/s in each coordinate.
Case net(std::uint64_t seed, int n, int pins, double speed, double step, int steps, double limit) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  Draft mesh = cases::points(n * n, 0);
  mesh.parts.gravity.setZero();
  Positions& x = mesh.scene.start.x;
  const auto join = [&](int a, int b) {
    if (a >= pins || b >= pins) mesh.constrain(a, b, (x.col(b) - x.col(a)).norm());
  };
  for (int v = 0; v < n * n; ++v) {
    const int row = v / n, column = v % n;
    x.col(v) << column + uniform(-0.2, 0.2), uniform(-0.3, 0.3), row + uniform(-0.2, 0.2);
    mesh.parts.mass[v] = uniform(0.1, 1);
    if (v < pins) mesh.parts.pinned.push_back(v);
    for (int axis = 0; axis < 3 && v >= pins; ++axis)
      mesh.scene.start.v(axis, v) = uniform(-speed, speed);
    if (column > 0) join(v - 1, v);
    if (row > 0) join(v, v - n);  // both orientations occur
  }
  mesh.scene.size = n;
  return case_of(text("net of ", n, " x ", n, ", seed ", seed), finished(std::move(mesh)), step,
                 steps, limit);
}

// The drape without the parts that the solver does not take.
Case drape(const Backend& solver, double step, int steps) {
  SceneParameters given{{"n", 9}};
  if (!solver.takes_shear) given["shear"] = 0;
  if (!solver.takes_collider) given["radius"] = 0;
  return case_of("drape of 9 x 9", built_scene("drape", given), step, steps);
}

bool keeps_a_limit(const Backend& solver) {
  return solver.strain_control == StrainControl::strain_limit;
}

std::unique_ptr<Stepper> stepper_for(const Examinee& solver, const Case& c,
                                     const Settings& settings = {}) {
  try {
    return make_stepper(solver.backend.name, c.scene.problem,
                        {c.strain_limit, solver.options.seed, settings, &c.scene.start});
  } catch (const std::invalid_argument& error) {
    throw NotTaken(error.what());
  }
}

// Those of the cases that the solver takes. Throws NotTaken if there are none.
std::vector<Case> taken(const Examinee& solver, std::vector<Case> cases) {
  std::string why;
  std::erase_if(cases, [&](const Case& c) {
    try {
      stepper_for(solver, c);
      return false;
    } catch (const NotTaken& reason) {
      why = reason.what();
      return true;
    }
  });
  if (cases.empty()) throw NotTaken(why);
  return cases;
}

Case short_chain(const std::string& name, int vertices, double step, int steps, double limit) {
  return case_of(text(name, " of ", vertices), built_scene(name, {{"n", vertices}}), step, steps,
                 limit);
}

bool same_bits(const State& a, const State& b) {
  const auto same = [](const Positions& p, const Positions& q) {
    return p.cols() == q.cols() && std::memcmp(p.data(), q.data(), sizeof(double) * p.size()) == 0;
  };
  return same(a.x, b.x) && same(a.v, b.v) && a.time == b.time;
}

// ---- Pins, limit and counters of ordinary scenes at ordinary steps ----

struct Runs {
  std::int64_t steps = 0;
  double worst = 0;  // strain over limit
  double momentum_defect = 0;
  std::string stopped;
  std::map<Promise, std::string> broken;  // and where

  void take(const Examinee& solver, const Case& c) {
    const TrialResult result =
        run_trial([&c] { return c; }, solver.backend.name, solver.options.seed);
    steps += result.work.steps;
    raise(worst, result.max_strain / c.strain_limit);
    raise(momentum_defect, result.momentum_defect);
    const std::string what = text(result.detail, " at ", c.name, ", step ", result.work.steps);
    if (result.broken != Promise::none) broken.try_emplace(result.broken, what);
    const bool survived =
        result.outcome == Outcome::survived || result.outcome == Outcome::survived_smaller;
    if (stopped.empty() && !survived &&
        (result.broken == Promise::none || result.broken == Promise::finite))
      stopped = what;
  }
};

Findings ordinary_runs(const Examinee& solver) {
  Runs all;
  std::vector<Case> cases{short_chain("chain", 20, 1.0 / 400, 80, 0.01),
                          drape(solver.backend, 1.0 / 400, 60)};
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    cases.push_back(net(seed, 5, 2, 2, 0.005, 10, 0.005));
  cases = taken(solver, std::move(cases));
  for (const Case& c : cases) all.take(solver, c);
  const std::string pins = all.broken[Promise::pins], counters = all.broken[Promise::counters],
                    limit = all.broken[Promise::strain] + all.broken[Promise::contact],
                    worst = number_text(all.worst, 4);
  return {
      judged(all.stopped.empty(), "steps",
             all.stopped.empty() ? text(all.steps, " steps of ", cases.size(),
                                        " of 6 scenes (a chain, a drape, nets)")
                                 : "it does not get through " + all.stopped,
             "easy scenes: at small steps the candidate nearly meets the limit; look at the "
             "iteration limit and at what ends the iteration"),
      judged(pins.empty(), "pins",
             pins.empty() ? text("none moved in ", all.steps, " steps") : pins,
             "a pinned vertex's inverse mass is 0; do not write to it, rounding moves it too"),
      keeps_a_limit(solver.backend)
          ? judged(
                limit.empty(), "limit", text("largest strain ", worst, " of the limit (allowed 1)"),
                limit +
                    ": return ok only where every edge keeps | |d| / l - 1 | <= strain_limit "
                    "(EdgeConstraints::permissible), before the collision filter; refuse otherwise")
          : not_applicable("limit", text(solver.backend.strain_control == StrainControl::stiffness
                                             ? "no limit of its own, sweeps search its stiffness"
                                             : "promises no limit",
                                         "; here ", worst, " of it")),
      judged(counters.empty(), "counters",
             counters.empty() ? "steps are counted and no counter falls" : counters,
             "only add to the WorkCounters that apply() is given, and return the iterations of "
             "this step alone")};
}

// ---- Linear and angular momentum of a free, weightless net ----

// A hundredth of the strain that a step causes: with a limit near that strain, the step decides
// which edges are corrected, and the loss has no order in it.
constexpr double momentum_limit = 1e-5;
// What edges may do within their limit has no order in the step: a hundredth of it is tolerated.
constexpr double spin_tolerance = 0.01 * momentum_limit;
// Defect at a quarter of the step over this one: 1/4 for an error of first order in h, 1 for one
// that steps do not lessen; between the two, on a logarithmic scale.
constexpr double vanishing = 0.5;

// kg m^2/s, what changes of angular momentum are compared with.
double spin_scale(const Scene& scene) {
  double sum = 0;
  for (Eigen::Index i = 0; i < scene.start.v.cols(); ++i)
    sum += scene.problem->mass()[i] * scene.start.v.col(i).norm();
  return sum * scene.size;
}

// Relative change of angular momentum over the run; infinite if a step is refused.
double loss_of_spin(const Examinee& solver, const Case& c, int refinement) {
  const Problem& problem = *c.scene.problem;
  const auto stepper = stepper_for(solver, c);
  State state = c.scene.start;
  const Eigen::Vector3d start = angular_momentum(problem, state);
  const double scale = spin_scale(c.scene);
  const DriveState driven = drive(*stepper, state, {c.step / refinement, refinement * c.steps});
  if (driven.end == DriveState::End::refused) return std::numeric_limits<double>::infinity();
  return (angular_momentum(problem, state) - start).norm() / scale;
}

Findings momentum(const Examinee& solver) {
  const char *linear = "linear momentum", *angular = "angular momentum";
  if (!solver.backend.conserves_momentum) {
    const char* why =
        "vertices are moved one by one, or forces turn: conserved only where it has converged";
    return {not_applicable(linear, why), not_applicable(angular, why)};
  }
  Runs all;
  double coarse = 0, fine = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Case c = net(seed, 5, 0, 0.5, 0.002, 20, momentum_limit);
    stepper_for(solver, c);  // throws NotTaken
    all.take(solver, c);
    coarse += loss_of_spin(solver, c, 1) / 4;
    fine += loss_of_spin(solver, c, 4) / 4;
  }
  if (std::isinf(coarse + fine)) {
    const char* refuses = "not measured: it refuses a step of 0.002 s of a free net";
    const std::string easy = text("strain limit ", momentum_limit,
                                  ", speeds of 0.5 m/s, edges of 1 m: a small correction");
    return {judged(false, linear, refuses, easy), judged(false, angular, refuses, easy)};
  }
  const double allowed = std::max(vanishing * coarse, spin_tolerance);
  return {
      judged(!all.broken.contains(Promise::momentum), linear,
             text("changes by ", all.momentum_defect, " of what flows in a step (allowed 1e-9)"),
             "nothing outside acts: corrections of an edge's two ends, times their masses, must "
             "cancel (share by inverse mass)"),
      judged(fine <= allowed, angular,
             text("changes by ", coarse, " of its scale at h, ", fine, " at h/4 (allowed ", allowed,
                  ": it vanishes with the step)"),
             "corrections must act along their edge, at its direction within the step; about the "
             "origin or along fixed axes they exert a torque")};
}

// Steps that no method can take.
Findings refusal(const Examinee& solver) {
  const std::string torn = "a row between pins 20 % farther apart than it is long";
  Case fast_net = net(1, 4, 1, 2, 0.01, 1, 0.005),
       fast_chain = short_chain("chain", 6, 0.01, 1, 0.01);
  fast_net.scene.start.v *= 1e300;
  fast_chain.scene.start.v.rightCols(5).row(1).setConstant(1e300);
  fast_net.name = fast_chain.name = "speeds of 1e300 m/s";
  int refused = 0, accepted = 0;
  std::string wrong;
  for (const Case& c : taken(
           solver, {case_of(torn, built_scene("taut_row", {{"stretch", 1.2}, {"n", 12}}), 0.01, 1),
                    fast_net, fast_chain})) {
    State state = c.scene.start;
    state.time = 2;
    const State before = state;
    const auto stepper = stepper_for(solver, c);
    const StepResult result = stepper->advance(state, c.step);
    ++(result ? accepted : refused);
    State later = c.scene.start, fresh = later;
    later.v.setZero();
    fresh.v.setZero();
    if (!result) {
      stepper->advance(later, c.step);
      stepper_for(solver, c)->advance(fresh, c.step);
    }
    if (result && !(state.x.allFinite() && state.v.allFinite()))
      wrong = c.name + ": a state that is not finite was accepted; test what you return";
    else if (result && c.name == torn && keeps_a_limit(solver.backend))
      wrong = c.name + ": accepted, although no positions keep the limit";
    else if (!result && !same_bits(state, before))
      wrong = c.name +
              ": the refused step changed the state; work on copies, x_start is not yours, and a "
              "step controller repeats the step from it";
    else if (!result && std::string(result.detail).empty())
      wrong = c.name + ": refused without a reason in StepResult::detail";
    else if (!same_bits(later, fresh))
      wrong = c.name +
              ": after the refused step the next one is not that of a new object; what a step "
              "remembers for the next one it must forget when it is refused";
  }
  return {judged(
      wrong.empty(), "refusal",
      text(refused, " impossible steps refused, ", accepted,
           " taken with finite positions; state bit for bit as it was, and nothing remembered: ",
           wrong.empty() ? "yes" : "no, or not refused"),
      wrong)};
}

// A candidate that keeps the limit already.
Findings permissible_candidate(const Examinee& solver) {
  const char* check = "permissible candidate";
  // A setting of this name means the same in every row (setting_fields.h), plug-ins' too.
  Settings defaults = complete_settings(solver.backend, {});
  if (defaults.contains("min_iterations") && std::get<double>(defaults["min_iterations"]) > 0)
    return {not_applicable(check, "corrected too, by its setting min_iterations")};
  if (!keeps_a_limit(solver.backend)) return {not_applicable(check, "no limit of its own")};
  double moved = 0, worst = 0, worst_candidate = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Case c = net(seed, 5, 1, 0.1, 0.01, 1, 0.05);
    State state = c.scene.start;
    WorkCounters nobodys;
    Positions candidate;
    inextensible::unconstrained_step(*c.scene.problem, state, c.step, candidate, nobodys);
    if (!stepper_for(solver, c)->advance(state, c.step))
      return {judged(false, check, "refused", "there is nothing to correct: return ok at once")};
    moved = std::max(moved, (state.x - candidate).cwiseAbs().maxCoeff());
    worst = std::max(worst, strain_range(*c.scene.problem, state.x).most);
    worst_candidate = std::max(worst_candidate, strain_range(*c.scene.problem, candidate).most);
  }
  return {judged(moved == 0 || worst <= worst_candidate, check,
                 moved == 0 ? "left alone"
                            : text("moved by up to ", moved, " m; largest strain ", worst,
                                   " (the candidate's, allowed: ", worst_candidate, ")"),
                 "a correction of what keeps the limit made it worse: test the candidate first")};
}

// The same bits beside another instance.
Findings determinism(const Examinee& solver) {
  const Case other = taken(
      solver, {net(9, 4, 1, 2, 0.005, 1, 0.005), short_chain("chain", 9, 0.005, 1, 0.005)})[0];
  std::string difference;
  int steps = 0;
  for (const Case& c :
       taken(solver, {net(5, 5, 2, 2, 0.0025, 20, 0.005), drape(solver.backend, 1.0 / 800, 40),
                      short_chain("chain", 20, 1.0 / 400, 20, 0.01)})) {
    const auto alone = stepper_for(solver, c);
    std::vector<State> path;
    State state = c.scene.start;
    for (int i = 0; i < c.steps; ++i) {
      alone->advance(state, c.step);  // refusals must repeat as well
      path.push_back(state);
    }
    const auto again = stepper_for(solver, c), neighbour = stepper_for(solver, other);
    State theirs = other.scene.start;
    state = c.scene.start;
    for (std::size_t i = 0; i < path.size(); ++i, ++steps) {
      again->advance(state, c.step);
      neighbour->advance(theirs, other.step);
      if (difference.empty() && !same_bits(state, path[i]))
        difference = text("positions or velocities differ by ",
                          std::max((state.x - path[i].x).cwiseAbs().maxCoeff(),
                                   (state.v - path[i].v).cwiseAbs().maxCoeff()),
                          " at ", c.name, ", step ", i + 1);
    }
    if (difference.empty() && !(again->work() == alone->work()))
      difference = "counters differ at " + c.name;
  }
  return {judged(
      difference.empty(), "determinism",
      text(steps, " steps repeated beside another instance: ",
           difference.empty() ? "the same bits and counters" : difference),
      "one seed, one result: no static or global state, no clock, no std::rand, no memory that was "
      "not initialized, no order of addresses; random numbers from BackendOptions::seed")};
}

// Tolerance of errors of fine runs, h = 0.00025 s, over the scene's size: five times g t h / 2, by
// which symplectic Euler's free fall is off after 0.32 s.
constexpr double largest_error = 2e-3;

// Smaller steps, smaller error, towards the right motion.
Findings consistency(const Examinee& solver) {
  const char* check = "consistency";
  constexpr int links = 7;
  // Distances from a run of h/16: (1/2 - 1/16) / (1 - 1/16) = 0.47 for a method of first order, 1
  // for what does not vanish with h; between the two, on a logarithmic scale.
  constexpr double not_vanishing = 0.68;
  const Case c = short_chain("chain", links + 1, 0.32 / 80, 80, 1e-6);
  // How far a step is iterated is a tolerance, not a part of the formula: it must not show.
  Settings settings;
  if (complete_settings(solver.backend, {}).contains("direction_tolerance"))
    settings["direction_tolerance"] = 0.01;
  std::vector<Positions> ends;
  for (const int refinement : {1, 2, 16}) {
    const auto stepper = stepper_for(solver, c, settings);
    State state = c.scene.start;
    const DriveState driven = drive(*stepper, state, {c.step / refinement, refinement * c.steps});
    if (driven.end == DriveState::End::refused)
      return {
          judged(false, check,
                 text("not measured: refuses h = 1/", 250 * refinement,
                      " s on a falling chain of 8 at strain limit 1e-6: ", driven.result.detail),
                 "an easy scene; look at the iteration limit and at what ends the iteration")};
    ends.push_back(state.x);
  }
  const double coarse = rms_distance(c.scene, ends[0], ends[2]),
               half = rms_distance(c.scene, ends[1], ends[2]);
  bool passed = half <= not_vanishing * coarse || coarse < 1e-9;
  std::string measured = text("halving h takes the distance to its own fine run from ", coarse,
                              " to ", half, " (allowed ", not_vanishing * coarse, ")");
  if (solver.backend.strain_control != StrainControl::none) {
    Pendulum exact({std::vector<double>(links, 1.0 / (links + 1)),
                    std::vector<double>(links, 1.0 / links), 9.81},
                   std::vector<double>(links, 0.0));
    exact.advance(c.step * c.steps, 1e-12);
    const double error = rms_distance(c.scene, ends[2], exact.positions());
    passed = passed && error <= largest_error;
    measured +=
        text(", and that is ", error, " from the exact motion (allowed ", largest_error, ")");
  }
  return {judged(passed, check, measured,
                 "what a step changes must vanish with h: look for damping, relaxation or an "
                 "offset per step that does not depend on h")};
}

// A chain that whirls about the vertical like a rigid curve.
Findings motion_in_space(const Examinee& solver) {
  const char* check = "motion in space";
  if (solver.backend.strain_control == StrainControl::none)
    return {not_applicable(check, "it keeps no length")};
  const auto type = find_scene("whirling_chain");
  const Case c = short_chain(type->name, 7, 0.00025, 640, 1e-6);
  const Problem& problem = *c.scene.problem;
  const State start = start_of(c.scene, solver.backend, c.step);
  State end = start;
  const DriveState driven = drive(*stepper_for(solver, c), end, {c.step, c.steps});
  if (driven.end == DriveState::End::refused)
    return {judged(false, check, text("refuses a step: ", driven.result.detail), "an easy scene")};
  const double error = rms_distance(c.scene, end.x,
                                    type->exact(complete_parameters(*type, {{"n", 7}}), end.time)),
               energy = (total_energy(problem, end) - total_energy(problem, start)) /
                        energy_scale(c.scene),
               spin = (angular_momentum(problem, end) - angular_momentum(problem, start)).y() /
                      spin_scale(c.scene);
  return {judged(
      std::max({error, std::abs(energy), std::abs(spin)}) <= largest_error, check,
      text("a whirling chain is ", error, " from its place; its energy changes by ", energy,
           ", its angular momentum about the vertical by ", spin, " (allowed ", largest_error, ")"),
      "a pin exerts no torque about itself, and weight none about the vertical: look for what "
      "treats directions differently, or damps by the step")};
}

// Every hard case of the profile "quick".
Findings all_hard_cases(const Examinee& solver) {
  const char* check = "hard cases";
  if (!solver.options.hard_cases) return {not_applicable(check, "left out")};
  if (!solver.backend.contestant) return {not_applicable(check, "for contestants only")};
  const StabilityPlan plan{{solver.backend.name}, hard_cases("quick")};
  const StabilityOutcome outcome = run_stability(plan, solver.options.seed, {});
  std::map<Outcome, int> ended;
  std::string advice;
  for (const StabilityCell& cell : outcome.cells) {
    ++ended[cell.result.outcome];
    if (cell.expected || cell.known) continue;
    advice += text(advice.empty() ? "" : "\n", cell.hard_case->name, " (", cell.hard_case->what,
                   "): ", to_string(cell.result.fixed), ", ", cell.result.detail);
  }
  const int unexpected = outcome.counts().new_differences,
            known = outcome.counts().not_as_expected - unexpected;
  return {judged(unexpected == 0, check,
                 text(outcome.cells.size(),
                      " cases: ", ended[Outcome::survived] + ended[Outcome::survived_smaller],
                      " survived, ", ended[Outcome::refused], " refused, ", ended[Outcome::timeout],
                      " too slow; ", unexpected, " ended as they should not (allowed 0)",
                      known == 0 ? "" : text(", besides ", known, " known ones")),
                 advice)};
}

struct Check {
  const char* name;
  Findings (*run)(const Examinee&);  // throws NotTaken
  double timeout = 120;              // s
};

constexpr Check checks[] = {{"ordinary runs", ordinary_runs},
                            {"momentum", momentum},
                            {"refusal", refusal},
                            {"permissible candidate", permissible_candidate},
                            {"determinism", determinism},
                            {"consistency", consistency},
                            {"motion in space", motion_in_space},
                            {"hard cases", all_hard_cases, 3600}};

}  // namespace

std::vector<Finding> examine(const std::string& solver, const ConformanceOptions& options) {
  const Examinee examinee{*find_backend(solver), options};
  std::vector<Finding> findings;
  for (const Check& check : checks) {
    // In a process of its own: the solver may crash, hang or end the program.
    const Findings found = in_child(
        {check.timeout, 0, options.interrupted},
        [&](Heartbeat& /*heartbeat*/) -> json {
          try {
            return check.run(examinee);
          } catch (const NotTaken& reason) {  // a scene that is not taken is none to examine it on
            return Findings{not_applicable(check.name, std::string("not taken: ") + reason.what())};
          }
        },
        [](const json& list) { return list.get<Findings>(); },
        [&](const ChildOutcome& child) {
          return Findings{{Grade::fail, check.name, ending(child),
                           "run it alone under a debugger: the checks are in "
                           "harness/stability/conformance.cpp"}};
        });
    for (const Finding& finding : found) {
      findings.push_back(finding);
      options.finding(finding);
    }
  }
  return findings;
}

}  // namespace harness
