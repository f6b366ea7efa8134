// The checks of one run through a hard case, step after step: the harness's word against the
// solver's.
#pragma once

#include <optional>

#include "harness/judge/drive.h"
#include "harness/judge/energy.h"
#include "harness/judge/mechanics.h"
#include "harness/stability/trial.h"
#include "solvers/problem/obstacle.h"

namespace harness {

// Disturbs the steps of a drive, judges them, and raises the figures of a result. Stops where a
// step decides the outcome (`wrong` or `diverged`, with the reason in the result's detail).
class TrialJudge : public Observer {
 public:
  // All must outlive this.
  TrialJudge(const Trial& trial, const inextensible::Backend& backend,
             const inextensible::Stepper& stepper, TrialResult& result);

  int before(inextensible::State& state, const DriveState& driven);
  bool after(const inextensible::State& state, const DriveState& driven);
  // The same of a step of h seconds. filtered: positions before the collision filter.
  bool after(const inextensible::Positions& filtered, const inextensible::State& state, double h);
  // The outcome, after the last step.
  Outcome finish();

 private:
  // Each returns whether nothing is wrong.
  bool fail(Outcome outcome, const std::string& why, Promise broken = Promise::none);
  bool broke(Promise promise, const std::string& why) { return fail(Outcome::wrong, why, promise); }
  bool judge_counters(const DriveState& driven);
  bool judge_strain(const inextensible::Positions& filtered, const inextensible::State& state);
  bool judge_limit(const StrainRange& worst, const char* when);
  bool judge_contact(const inextensible::State& state);
  bool judge_momentum(const inextensible::State& state, double h);
  bool judge_energy(const inextensible::State& state, double h);
  bool judge_gain(std::optional<double> gain, double release);

  const Trial& trial_;
  const inextensible::Problem& problem_;
  const inextensible::Stepper& stepper_;
  TrialResult& result_;
  Outcome outcome_ = Outcome::survived;
  bool limit_promised_;  // the solver claims to keep the trial's strain limit
  double mass_;
  bool free_;            // nothing outside but gravity acts
  bool judged_ = false;  // whether energy is
  bool energy_known_;    // what it is judged against; not before the first step of a start that
                         // violates the limit
  EnergyRecord energy_;
  double release_ = 0;  // of energy by slack in the last step
  inextensible::State start_;
  inextensible::WorkCounters work_;  // before the step
  // With contact inside only: where the obstacle is, and what is in it.
  std::optional<inextensible::Obstacle> obstacle_;
  std::vector<inextensible::ContactPlane> inside_;
};

}  // namespace harness
