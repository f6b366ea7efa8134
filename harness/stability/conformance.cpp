#include "harness/stability/conformance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "harness/base/text.h"
#include "harness/judge/reference.h"
#include "harness/scenes/pendulum.h"
#include "harness/scenes/scene.h"
#include "harness/stability/stability.h"
#include "harness/stability/trial_judge.h"
#include "inextensible/problem/forces.h"
#include "inextensible/registry.h"
#include "inextensible/stepping/step_controller.h"

namespace harness {
namespace {

using Eigen::Vector3d;
using inextensible::Backend;
using inextensible::Knob;
using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;
using inextensible::Stepper;
using inextensible::StepResult;
using inextensible::WorkCounters;
using Grade = Finding::Grade;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Case {
  std::string name;
  Scene scene;
  double step;  // s
  int steps;
  double limit;
};

Case scene_case(const std::string& name, const char* type, const SceneParameters& given,
                double step, int steps) {
  const SceneType& scene = *find_scene(type);
  return {name, scene.build(complete_parameters(scene, given)), step, steps, 0.01};
}

// A crumpled net of n x n vertices about 1 m apart, masses over a decade, weightless; speeds up to
// `speed` in each coordinate.
Case net(std::uint64_t seed, int n, int pins, double speed, double step, int steps, double limit) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  inextensible::ProblemParts parts;
  parts.gravity.setZero();
  Scene scene;
  scene.size = n;
  scene.start.x.resize(3, n * n);
  scene.start.v.setZero(3, n * n);
  const auto join = [&](int a, int b) {
    if (a < pins && b < pins) return;
    parts.edges.push_back({a, b});
    parts.rest_length.push_back((scene.start.x.col(b) - scene.start.x.col(a)).norm());
  };
  for (int v = 0; v < n * n; ++v) {
    const int row = v / n, column = v % n;
    scene.start.x.col(v) << column + uniform(-0.2, 0.2), uniform(-0.3, 0.3),
        row + uniform(-0.2, 0.2);
    parts.mass.push_back(uniform(0.1, 1));
    if (v < pins) {
      parts.pinned.push_back(v);
    } else {
      for (int axis = 0; axis < 3; ++axis) scene.start.v(axis, v) = uniform(-speed, speed);
    }
    if (column > 0) join(v - 1, v);
    if (row > 0) join(v, v - n);  // both orientations occur
  }
  scene.problem = std::make_shared<const Problem>(std::move(parts));
  return {
      "net of " + std::to_string(n) + " x " + std::to_string(n) + ", seed " + std::to_string(seed),
      std::move(scene), step, steps, limit};
}

bool same_bits(const Positions& a, const Positions& b) {
  return a.cols() == b.cols() &&
         std::equal(a.data(), a.data() + a.size(), b.data(), [](double p, double q) {
           return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
         });
}

bool same_bits(const State& a, const State& b) {
  return same_bits(a.x, b.x) && same_bits(a.v, b.v) && a.time == b.time;
}

Vector3d linear_momentum(const Problem& problem, const Positions& v) {
  return v * Eigen::Map<const Eigen::VectorXd>(problem.mass().data(), problem.vertices());
}

// About the centre of mass.
Vector3d spin(const Problem& problem, const State& state) {
  const Vector3d centre = linear_momentum(problem, state.x) / problem.total_mass();
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    const Vector3d arm = state.x.col(i) - centre, velocity = state.v.col(i);
    sum += problem.mass()[static_cast<std::size_t>(i)] * arm.cross(velocity);
  }
  return sum;
}

std::vector<std::int64_t> counts_of(const WorkCounters& w) {
  return {w.steps,
          w.rejected_steps,
          w.iterations,
          w.assemblies,
          w.factorizations,
          w.back_solves,
          w.linear_iterations,
          w.edge_projections,
          w.line_search_steps,
          w.spring_evaluations,
          w.triangle_tests,
          w.contacts};
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  stream.precision(3);
  (stream << ... << parts);
  return stream.str();
}

class Examination {
 public:
  Examination(const Backend& backend, const ConformanceOptions& options)
      : backend_(backend), options_(options), limited_(backend.knob == Knob::strain_limit) {}

  std::vector<Finding> run() {
    ordinary_runs();
    momentum();
    refusal();
    permissible_candidate();
    determinism();
    consistency();
    tell(Grade::not_applicable, "allocations",
         "not counted here; tests/solvers/methods/no_allocation_test.cpp shows how: none in a step "
         "after the first",
         "");
    hard_cases();
    return std::move(findings_);
  }

 private:
  void tell(Grade grade, const std::string& check, const std::string& measured,
            const std::string& advice) {
    findings_.push_back({grade, check, measured, grade == Grade::fail ? advice : ""});
    options_.finding(findings_.back());
  }
  void judge(bool passed, const std::string& check, const std::string& measured,
             const std::string& advice) {
    tell(passed ? Grade::pass : Grade::fail, check, measured, advice);
  }

  std::unique_ptr<Stepper> stepper(const Case& c) const {
    return inextensible::make_stepper(backend_.name, c.scene.problem, {c.limit, options_.seed, {}});
  }

  // All that ordinary runs tell, in one pass over them.
  struct Ordinary {
    int steps = 0, smaller = 0;  // smaller: accepted ones shorter than the case's own
    std::string stopped;
    int moved_pins = 0, places = 0;
    std::string first_moved;
    double worst = 0;  // strain over limit
    std::string worst_place;
    std::string wrong_count;
  };
  void ordinary_runs();
  void drive(const Case& c, Ordinary& all) const;
  void look(const Case& c, const Stepper& stepper, const State& state, Ordinary& all) const;

  void momentum();
  double loss_of_spin(const Case& c, double step, double& linear) const;
  void refusal();
  void permissible_candidate();
  void determinism();
  void consistency();
  void hard_cases();

  const Backend& backend_;
  const ConformanceOptions& options_;
  bool limited_;
  std::vector<Finding> findings_;
};

// ---- Pins, limit, counters: ordinary scenes at ordinary steps ----

void Examination::look(const Case& c, const Stepper& stepper, const State& state,
                       Ordinary& all) const {
  const Problem& problem = *c.scene.problem;
  const std::string place = text(c.name, ", step ", stepper.work().steps);
  for (const int pin : problem.pinned()) {
    ++all.places;
    const Positions now = state.x.col(pin), start = c.scene.start.x.col(pin);
    if (same_bits(now, start)) continue;
    if (all.moved_pins++ == 0)
      all.first_moved =
          text("vertex ", pin, " is pinned but moved by ", (now - start).norm(), " m at ", place);
  }
  const WorstEdge worst = worst_edge(problem, stepper.filtered_positions());
  if (worst.strain / c.limit > all.worst) {
    all.worst = worst.strain / c.limit;
    all.worst_place = text("edge ", worst.edge, " at ", place);
  }
}

void Examination::drive(const Case& c, Ordinary& all) const {
  const auto stepper = this->stepper(c);
  inextensible::StepController controller(*stepper, {.largest = c.step, .most_halvings = 10});
  State state = c.scene.start;
  std::int64_t accepted = 0;
  while (state.time < (c.steps - 0.5) * c.step || !controller.aligned()) {
    const std::vector<std::int64_t> before = counts_of(stepper->work());
    const StepResult result = controller.advance(state);
    if (!result) {
      all.stopped = text(c.name, " at t = ", state.time, " s, steps down to ", controller.next(),
                         " s: ", to_string(result.status), ", ", result.detail);
      return;
    }
    ++accepted;
    ++all.steps;
    if (controller.last() < c.step) ++all.smaller;
    look(c, *stepper, state, all);
    const std::vector<std::int64_t> after = counts_of(stepper->work());
    const bool falls =
        !std::equal(before.begin(), before.end(), after.begin(), std::less_equal<>());
    if (all.wrong_count.empty() &&
        (falls || stepper->work().steps != accepted || result.iterations < 0))
      all.wrong_count = text(falls ? "a counter fell" : "steps or iterations are wrong", " at ",
                             c.name, ", step ", accepted);
  }
}

void Examination::ordinary_runs() {
  std::vector<Case> cases{scene_case("chain of 20", "chain", {{"n", 20}}, 1.0 / 400, 80),
                          scene_case("drape of 9 x 9", "drape", {{"n", 9}}, 1.0 / 400, 60)};
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    cases.push_back(net(seed, 5, 2, 2, 0.005, 10, 0.005));
  Ordinary all;
  std::string stopped;
  for (const Case& c : cases) {
    drive(c, all);
    if (stopped.empty()) stopped = all.stopped;
  }
  judge(stopped.empty(), "steps",
        stopped.empty() ? text(all.steps, " steps of a chain, a drape and nets, ", all.smaller,
                               " of them smaller than asked for")
                        : "it does not get through " + stopped,
        "easy scenes: at small steps the candidate nearly meets the limit; look at the iteration "
        "limit and at what ends the iteration");
  judge(all.moved_pins == 0, "pins",
        text(all.moved_pins, " of ", all.places, " places of pinned vertices changed (allowed 0)"),
        all.first_moved +
            ": a pinned vertex's inverse mass is 0; do not write to it, rounding moves it too");
  if (limited_) {
    judge(all.worst <= 1 + 1e-9, "limit",
          text("largest strain ", number_text(all.worst, 4), " of the limit (allowed 1)"),
          all.worst_place +
              ": return ok only where every edge keeps | |d| / l - 1 | <= strain_limit "
              "(EdgeConstraints::permissible), before the collision filter; refuse otherwise");
  } else {
    tell(Grade::not_applicable, "limit",
         text(backend_.knob == Knob::stiffness ? "no limit of its own, sweeps search its stiffness"
                                               : "promises no limit",
              "; here ", number_text(all.worst, 4), " of it"),
         "");
  }
  judge(all.wrong_count.empty(), "counters",
        all.wrong_count.empty() ? "steps are counted and no counter falls" : all.wrong_count,
        "only add to the WorkCounters that apply() is given, and return the iterations of this "
        "step alone");
}

// ---- Momentum: a free, weightless net ----

constexpr double momentum_duration = 0.04;  // s
constexpr double momentum_tolerance = 1e-9, spin_tolerance = 1e-6;

// Raises `linear` to the largest relative change of linear momentum in a step; infinite if refused.
double Examination::loss_of_spin(const Case& c, double step, double& linear) const {
  const Problem& problem = *c.scene.problem;
  const auto stepper = this->stepper(c);
  State state = c.scene.start;
  const Vector3d start = spin(problem, state);
  double scale = 0;
  for (Eigen::Index i = 0; i < state.v.cols(); ++i)
    scale += problem.mass()[static_cast<std::size_t>(i)] * state.v.col(i).norm();
  for (int i = 0; i < std::lround(momentum_duration / step); ++i) {
    const Vector3d before = linear_momentum(problem, state.v);
    if (!stepper->advance(state, step)) return infinity;
    linear = std::max(linear, (linear_momentum(problem, state.v) - before).norm() / scale);
  }
  return (spin(problem, state) - start).norm() / (scale * c.scene.size);
}

void Examination::momentum() {
  double linear = 0, coarse = 0, fine = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Case c = net(seed, 5, 0, 0.5, 0.002, 0, 1e-4);
    coarse += loss_of_spin(c, c.step, linear) / 4;
    fine += loss_of_spin(c, c.step / 4, linear) / 4;
  }
  if (std::isinf(coarse + fine)) {
    for (const char* check : {"linear momentum", "angular momentum"})
      judge(false, check, "not measured: it refuses a step of 0.002 s of a free net",
            "strain limit 0.0001, speeds of 0.5 m/s, edges of 1 m: a small correction");
    return;
  }
  judge(linear <= momentum_tolerance, "linear momentum",
        text("changes by ", linear, " of its scale in a step (allowed ", momentum_tolerance, ")"),
        "nothing outside acts: corrections of an edge's two ends, times their masses, must cancel "
        "(share by inverse mass)");
  const double allowed = std::max(0.6 * coarse, spin_tolerance);
  judge(fine <= allowed, "angular momentum",
        text("changes by ", coarse, " of its scale at h, ", fine, " at h/4 (allowed ", allowed,
             ": it vanishes with the step)"),
        "corrections must act along their edge, at its direction within the step; about the origin "
        "or along fixed axes they do torque");
}

// ---- Refusal ----

void Examination::refusal() {
  Case torn = scene_case("a row between pins 20 % farther apart than it is long", "taut_row",
                         {{"stretch", 1.2}, {"n", 12}}, 0.01, 1);
  Case overflow = net(1, 4, 1, 2, 0.01, 1, 0.005);
  overflow.name = "speeds of 1e300 m/s";
  overflow.scene.start.v *= 1e300;
  int refused = 0, accepted = 0;
  std::string wrong;
  for (const Case* c : {&torn, &overflow}) {
    State state = c->scene.start;
    state.time = 2;
    const State before = state;
    const StepResult result = stepper(*c)->advance(state, c->step);
    if (result) {
      ++accepted;
      if (!state.x.allFinite() || !state.v.allFinite()) {
        wrong = c->name + ": a state that is not finite was accepted; test what you return";
      } else if (c == &torn && limited_) {
        wrong = c->name + ": accepted, although no positions keep the limit";
      }
      continue;
    }
    ++refused;
    if (!same_bits(state, before))
      wrong = c->name +
              ": the refused step changed the state; work on copies, x_start is not "
              "yours, and a step controller repeats the step from it";
    else if (std::string(result.detail).empty())
      wrong = c->name + ": refused without a reason in StepResult::detail";
  }
  judge(wrong.empty(), "refusal",
        text(refused, " impossible steps refused, ", accepted,
             " taken with finite positions; state bit for bit as it was: ",
             wrong.empty() ? "yes" : "no, or not refused"),
        wrong);
}

// ---- A candidate that keeps the limit already ----

void Examination::permissible_candidate() {
  const char* check = "permissible candidate";
  for (const auto& setting : backend_.settings) {
    if (setting.name == std::string("min_iterations") && std::get<double>(setting.initial) > 0)
      return tell(Grade::not_applicable, check, "corrected too, by its setting min_iterations", "");
  }
  if (!limited_) return tell(Grade::not_applicable, check, "no limit of its own", "");
  double moved = 0, worst = 0, worst_candidate = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Case c = net(seed, 5, 1, 0.1, 0.01, 1, 0.05);
    State state = c.scene.start;
    WorkCounters nobodys;
    Positions candidate;
    inextensible::unconstrained_step(*c.scene.problem, state, c.step, candidate, nobodys);
    if (!stepper(c)->advance(state, c.step))
      return judge(false, check, "refused", "there is nothing to correct: return ok at once");
    moved = std::max(moved, (state.x - candidate).cwiseAbs().maxCoeff());
    worst = std::max(worst, worst_edge(*c.scene.problem, state.x).strain);
    worst_candidate = std::max(worst_candidate, worst_edge(*c.scene.problem, candidate).strain);
  }
  judge(moved == 0 || worst <= worst_candidate, check,
        moved == 0 ? "left alone"
                   : text("moved by up to ", moved, " m; largest strain ", worst,
                          " (the candidate's, allowed: ", worst_candidate, ")"),
        "a correction of what keeps the limit made it worse: test the candidate first");
}

// ---- Determinism ----

void Examination::determinism() {
  const Case other = net(9, 4, 1, 2, 0.005, 1, 0.005);
  std::string difference;
  int steps = 0;
  for (const Case& c : {net(5, 5, 2, 2, 0.0025, 20, 0.005),
                        scene_case("drape of 9 x 9", "drape", {{"n", 9}}, 1.0 / 800, 40)}) {
    const auto alone = stepper(c);
    std::vector<State> path;
    State state = c.scene.start;
    for (int i = 0; i < c.steps; ++i) {
      alone->advance(state, c.step);  // refusals must repeat as well
      path.push_back(state);
    }
    const auto again = stepper(c), neighbour = stepper(other);
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
  judge(difference.empty(), "determinism",
        text(steps, " steps repeated beside another instance: ",
             difference.empty() ? "the same bits and counters" : difference),
        "one seed, one result: no static or global state, no clock, no std::rand, no memory that "
        "was not initialized, no order of addresses; random numbers from BackendOptions::seed");
}

// ---- Consistency: smaller steps, smaller error, towards the right motion ----

void Examination::consistency() {
  const char* check = "consistency";
  constexpr int links = 7;
  constexpr double largest_error = 0.01;  // of the fine run, over the scene's size
  const Case c = scene_case("chain of 8", "chain", {{"n", links + 1}}, 0.32 / 80, 80);
  std::vector<Positions> ends;
  for (const int refinement : {1, 2, 16}) {
    Case fine = c;
    fine.limit = 1e-6;
    const auto stepper = this->stepper(fine);
    State state = c.scene.start;
    for (int i = 0; i < refinement * c.steps; ++i) {
      if (const StepResult result = stepper->advance(state, c.step / refinement); !result)
        return judge(false, check,
                     text("not measured: refuses h = 1/", 250 * refinement,
                          " s on a falling chain of 8 at strain limit 1e-6: ", result.detail),
                     "an easy scene; look at the iteration limit and at what ends the iteration");
    }
    ends.push_back(state.x);
  }
  const double coarse = rms_distance(c.scene, ends[0], ends[2]),
               half = rms_distance(c.scene, ends[1], ends[2]);
  const std::string measured = text("halving h takes the distance to its own fine run from ",
                                    coarse, " to ", half, " (allowed ", 0.7 * coarse, ")");
  const char* advice =
      "what a step changes must vanish with h: look for a damping, a relaxation or an offset a "
      "step that does not know h";
  const bool converges = half <= 0.7 * coarse || coarse < 1e-9;
  if (backend_.knob == Knob::none) return judge(converges, check, measured, advice);
  Pendulum exact({std::vector<double>(links, 1.0 / (links + 1)),
                  std::vector<double>(links, 1.0 / links), 9.81},
                 std::vector<double>(links, 0.0));
  exact.advance(c.step * c.steps, 1e-12);
  const double error = rms_distance(c.scene, ends[2], exact.positions());
  judge(converges && error <= largest_error, check,
        text(measured, ", and that is ", error, " from the exact motion (allowed ", largest_error,
             ")"),
        advice);
}

// ---- Hard cases ----

constexpr double patience = 60;  // s; a verdict must not depend on how busy the machine is

void Examination::hard_cases() {
  const char* check = "hard cases";
  if (!options_.hard_cases) return tell(Grade::not_applicable, check, "left out", "");
  if (!backend_.contestant) return tell(Grade::not_applicable, check, "for contestants only", "");
  auto cases = harness::hard_cases(hard_case_values("quick"));
  for (HardCase& c : cases) {
    c.build = [build = c.build] {
      Trial trial = build();
      trial.timeout = patience;
      return trial;
    };
  }
  StabilityFilters filters;
  filters.solver = std::regex(backend_.name);
  filters.hard_case = std::regex("^(?!largest step)");
  const StabilityOutcome outcome = run_stability(cases, filters, options_.seed, {});
  int survived = 0, refused = 0, slow = 0, unexpected = 0;
  std::string advice;
  for (const StabilityCell& cell : outcome.cells) {
    const Outcome o = cell.result.outcome;
    survived += o == Outcome::survived || o == Outcome::survived_smaller;
    refused += o == Outcome::refused;
    slow += o == Outcome::timeout;
    if (cell.expected) continue;
    ++unexpected;
    advice += text(advice.empty() ? "" : "\n", cell.hard_case->name, " (", cell.hard_case->what,
                   "): ", to_string(cell.result.fixed), ", ", cell.result.detail);
  }
  judge(unexpected == 0, check,
        text(outcome.cells.size(), " cases: ", survived, " survived, ", refused, " refused, ", slow,
             " too slow; ", unexpected, " ended as they should not (allowed 0)"),
        advice);
}

}  // namespace

std::vector<Finding> examine(const std::string& solver, const ConformanceOptions& options) {
  return Examination(*inextensible::find_backend(solver), options).run();
}

bool conforms(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.grade == Grade::fail; });
}

}  // namespace harness
