// The checks of one run through a hard case, step after step: the harness's word against the
// solver's.
#pragma once

#include <optional>

#include "harness/judge/energy.h"
#include "harness/stability/trial.h"
#include "solvers/problem/obstacle.h"

namespace harness {

class TrialJudge {
 public:
  // The trial must outlive this.
  TrialJudge(const Trial& trial, const inextensible::Backend& backend);

  // Before and after each accepted step of h seconds. filtered: positions before the collision
  // filter. `after` raises the figures in `result` and gives the outcome if the step tells one
  // (`wrong` or `diverged`, with the reason in result.detail).
  void before(const inextensible::State& state);
  std::optional<Outcome> after(const inextensible::Positions& filtered,
                               const inextensible::State& state, double h, TrialResult& result);
  // After the last step, if none decided the outcome.
  std::optional<Outcome> finish(TrialResult& result);

 private:
  std::optional<Outcome> judge_energy(std::optional<double> gain, double release,
                                      TrialResult& result) const;
  std::optional<Outcome> judge_contact(const inextensible::State& state, TrialResult& result);
  double momentum_defect(const inextensible::State& state, double h) const;

  const Trial& trial_;
  const inextensible::Problem& problem_;
  bool limit_promised_;  // the solver claims to keep the trial's strain limit
  double mass_;
  bool free_;            // nothing outside but gravity acts
  bool judged_ = false;  // whether energy is
  bool energy_known_;    // what it is judged against; not before the first step of a start that
                         // violates the limit
  EnergyRecord energy_;
  double release_ = 0;  // of energy by slack in the last step
  inextensible::State start_;
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();
  // With contact inside only: where the obstacle is, and what is in it.
  std::optional<inextensible::Obstacle> obstacle_;
  std::vector<inextensible::ContactPlane> inside_;
};

}  // namespace harness
