// The checks of one run through a hard case, step after step: the harness's word against the
// solver's.
#pragma once

#include <optional>

#include "harness/stability/trial.h"

namespace harness {

class Witness {
 public:
  // limit_promised: the solver claims to keep the trial's strain limit. The trial must outlive
  // this.
  Witness(const Trial& trial, bool limit_promised);

  // Before and after each accepted step of h seconds. filtered: positions before the collision
  // filter. `after` raises the figures in `result` and gives the outcome if the step tells one
  // (`wrong` or `diverged`, with the reason in result.detail).
  void before(const inextensible::State& state);
  std::optional<Outcome> after(const inextensible::Positions& filtered,
                               const inextensible::State& state, double h, TrialResult& result);

 private:
  double momentum_defect(const inextensible::State& state, double h) const;

  const Trial& trial_;
  const inextensible::Problem& problem_;
  bool limit_promised_;
  double mass_;
  bool free_;                     // nothing outside but gravity acts
  bool judged_ = false;           // whether energy is
  double scale_;                  // of energy, J
  std::optional<double> energy_;  // J, what it is judged against; none before the first step of a
                                  // start that violates the limit
  inextensible::State start_;
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();
};

}  // namespace harness
