#include <algorithm>
#include <functional>

#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/stability/checks.h"

namespace harness {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;
using inextensible::Stepper;
using inextensible::StrainControl;
using inextensible::WorkCounters;

namespace {

// Counters that only grow; a factorization's size is that of the last one.
std::vector<std::int64_t> counts_of(const WorkCounters& w) {
  std::vector<std::int64_t> counts;
  counts.reserve(inextensible::work_counters.size());
  for (const auto& counter : inextensible::work_counters) {
    if (const auto* member = std::get_if<std::int64_t WorkCounters::*>(&counter.member))
      counts.push_back(w.**member);
  }
  return counts;
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

void look(const Case& c, const Stepper& stepper, const State& state, Ordinary& all) {
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

void take_steps(const Examinee& solver, const Case& c, Ordinary& all) {
  const auto stepper = solver.stepper(c);
  State state = c.scene.start;
  std::int64_t accepted = 0;
  std::vector<std::int64_t> before = counts_of(stepper->work());
  const auto look_on = [&](const State& now, const DriveState& driven) {
    ++accepted;
    ++all.steps;
    if (driven.last < c.step) ++all.smaller;
    look(c, *stepper, now, all);
    const std::vector<std::int64_t> after = counts_of(stepper->work());
    const bool falls =
        !std::equal(before.begin(), before.end(), after.begin(), std::less_equal<>());
    if (all.wrong_count.empty() &&
        (falls || stepper->work().steps != accepted || driven.result.iterations < 0))
      all.wrong_count = text(falls ? "a counter fell" : "steps or iterations are wrong", " at ",
                             c.name, ", step ", accepted);
    before = after;
    return true;
  };
  const DriveState driven = drive(*stepper, state, {c.step, c.steps, 10}, look_on);
  if (driven.end == DriveState::End::refused)
    all.stopped = text(c.name, " at t = ", state.time, " s, steps down to ", driven.next,
                       " s: ", to_string(driven.result.status), ", ", driven.result.detail);
}

}  // namespace

Findings check_ordinary_runs(const Examinee& solver) {
  std::vector<Case> cases{scene_case("chain of 20", "chain", {{"n", 20}}, 1.0 / 400, 80),
                          scene_case("drape of 9 x 9", "drape", solver.drape(9), 1.0 / 400, 60)};
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    cases.push_back(net(seed, 5, 2, 2, 0.005, 10, 0.005));
  Ordinary all;
  std::string stopped;
  for (const Case& c : cases) {
    take_steps(solver, c, all);
    if (stopped.empty()) stopped = all.stopped;
  }
  Findings findings;
  findings.push_back(judged(
      stopped.empty(), "steps",
      stopped.empty() ? text(all.steps, " steps of a chain, a drape and nets, ", all.smaller,
                             " of them smaller than asked for")
                      : "it does not get through " + stopped,
      "easy scenes: at small steps the candidate nearly meets the limit; look at the iteration "
      "limit and at what ends the iteration"));
  findings.push_back(judged(
      all.moved_pins == 0, "pins",
      text(all.moved_pins, " of ", all.places, " places of pinned vertices changed (allowed 0)"),
      all.first_moved +
          ": a pinned vertex's inverse mass is 0; do not write to it, rounding moves it too"));
  if (solver.keeps_a_limit()) {
    findings.push_back(judged(
        all.worst <= 1 + 1e-9, "limit",
        text("largest strain ", number_text(all.worst, 4), " of the limit (allowed 1)"),
        all.worst_place +
            ": return ok only where every edge keeps | |d| / l - 1 | <= strain_limit "
            "(EdgeConstraints::permissible), before the collision filter; refuse otherwise"));
  } else {
    findings.push_back(
        not_applicable("limit", text(solver.backend.strain_control == StrainControl::stiffness
                                         ? "no limit of its own, sweeps search its stiffness"
                                         : "promises no limit",
                                     "; here ", number_text(all.worst, 4), " of it")));
  }
  findings.push_back(judged(
      all.wrong_count.empty(), "counters",
      all.wrong_count.empty() ? "steps are counted and no counter falls" : all.wrong_count,
      "only add to the WorkCounters that apply() is given, and return the iterations of this "
      "step alone"));
  return findings;
}

}  // namespace harness
