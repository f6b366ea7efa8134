#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/stability/checks.h"

namespace harness {

using Eigen::Vector3d;
using inextensible::Problem;
using inextensible::State;

namespace {

constexpr double momentum_duration = 0.04;  // s
// A hundredth of the strain that a step causes. An edge that is within its limit is not corrected:
// with a limit near that strain, which edges are depends on the step, and the loss has no order in
// it.
constexpr double momentum_limit = 1e-5;
// Rounding, and the 1e-10 to which the KKT system's residual is refined.
constexpr double momentum_tolerance = 1e-9;
// What edges may do within their limit has no order in the step: a hundredth of it is let pass.
constexpr double spin_tolerance = 0.01 * momentum_limit;
// Defect at a quarter of the step over this one: 1/4 for an error of first order in h, 1 for one
// that steps do not lessen; between the two, on a logarithmic scale.
constexpr double vanishing = 0.5;

// Raises `linear` to the largest relative change of linear momentum in a step; infinite if refused.
double loss_of_spin(const Examinee& solver, const Case& c, double step, double& linear) {
  const Problem& problem = *c.scene.problem;
  const auto stepper = solver.stepper(c);
  State state = c.scene.start;
  const Vector3d start = angular_momentum(problem, state);
  double scale = 0;
  for (Eigen::Index i = 0; i < state.v.cols(); ++i)
    scale += problem.mass()[i] * state.v.col(i).norm();
  Vector3d before = linear_momentum(problem, state.v);
  const auto look = [&](const State& now, const DriveState& /*driven*/) {
    const Vector3d after = linear_momentum(problem, now.v);
    linear = std::max(linear, (after - std::exchange(before, after)).norm() / scale);
    return true;
  };
  const DriveState driven =
      drive(*stepper, state, {step, std::lround(momentum_duration / step)}, look);
  if (driven.end == DriveState::End::refused) return std::numeric_limits<double>::infinity();
  return (angular_momentum(problem, state) - start).norm() / (scale * c.scene.size);
}

}  // namespace

Findings check_momentum(const Examinee& solver) {
  if (!solver.backend.conserves_momentum) {
    const char* why =
        "vertices are moved one by one, or forces turn: conserved only where it has converged";
    return {not_applicable("linear momentum", why), not_applicable("angular momentum", why)};
  }
  double linear = 0, coarse = 0, fine = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Case c = net(seed, 5, 0, 0.5, 0.002, 0, momentum_limit);
    coarse += loss_of_spin(solver, c, c.step, linear) / 4;
    fine += loss_of_spin(solver, c, c.step / 4, linear) / 4;
  }
  if (std::isinf(coarse + fine)) {
    Findings refused;
    for (const char* check : {"linear momentum", "angular momentum"})
      refused.push_back(judged(false, check,
                               "not measured: it refuses a step of 0.002 s of a free net",
                               text("strain limit ", momentum_limit,
                                    ", speeds of 0.5 m/s, edges of 1 m: a small correction")));
    return refused;
  }
  const double allowed = std::max(vanishing * coarse, spin_tolerance);
  return {judged(linear <= momentum_tolerance, "linear momentum",
                 text("changes by ", linear, " of its scale in a step (allowed ",
                      momentum_tolerance, ")"),
                 "nothing outside acts: corrections of an edge's two ends, times their masses, "
                 "must cancel "
                 "(share by inverse mass)"),
          judged(fine <= allowed, "angular momentum",
                 text("changes by ", coarse, " of its scale at h, ", fine, " at h/4 (allowed ",
                      allowed, ": it vanishes with the step)"),
                 "corrections must act along their edge, at its direction within the step; about "
                 "the origin "
                 "or along fixed axes they do torque")};
}

}  // namespace harness
