// Soft step, or TGS soft (Catto 2024): velocity constraints by Gauss-Seidel, positions by a spring
// of the step's own frequency, and a second stage that takes the spring's velocity away again. It
// promises no strain limit: strain falls as h^2.
//
// With n_k the directions and C_k the elongations at the start, p_k the impulses, which the last
// step's forces begin, m_k = 1 / (w_a + w_b), omega = 2 pi frequency / h and zeta the damping
// (Catto, solver2d, solve_soft_step.c):
//   s = 2 zeta + h omega,  c = h omega s,  bias = omega / s,
//   first stage: dp = -m_k c / (1 + c) (n.(v_b - v_a) + bias C_k) - p_k / (1 + c);   x += h v;
//   second stage: dp = -m_k n.(v_b - v_a).
// Departures: n_k is that of the end in the second stage; the frequency is bounded by the step, not
// by 60 Hz. At rest the first stage leaves C_k = load / (m_k omega^2). Loops: two passes over
// edges, in the mesh's order.
#include <numbers>

#include "solvers/methods/rows.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {
namespace {

class SoftStep final : public Stepper {
 public:
  SoftStep(std::shared_ptr<const Problem> shared, const BackendOptions& options)
      : Stepper(std::move(shared)), passes_(options.count("passes")), edges_(problem(), 0) {
    const double angle = 2 * std::numbers::pi * options.number("frequency");  // h omega
    const double s = 2 * options.number("damping") + angle, c = angle * s;
    hardness_ = c / (1 + c);
    give_ = 1 / (1 + c);
    rate_ = angle / s;
    n_.resize(3, edges_.count());
    length_.resize(edges_.count());
    impulse_.resize(edges_.count());
    last_force_.setZero(edges_.count());
    if (problem().implicit_forces()) implicit_ = std::make_unique<ImplicitForces>(problem());
  }

 private:
  // Velocities are differences to the start of the step, times h.
  StepResult solve(const State& state, double h, Positions& x) override {
    Stopwatch stopwatch(phases_wanted_);
    if (!unconstrained_step(problem(), in_step(implicit_, h), state, h, x, work_))
      return {Status::singular, 0, -1, 0, singular_forces};
    phases_.unconstrained += stopwatch();
    directions(start_positions());
    impulse_ = h * h * last_force_;
    for (int k = 0; k < edges_.count(); ++k) pull(k, impulse_[k], x);
    for (int pass = 0; pass < passes_; ++pass)
      for (int k = 0; k < edges_.count(); ++k) {
        const double way = n_.col(k).dot(x.col(edges_.b[k]) - x.col(edges_.a[k])) - length_[k];
        const double mass = 1 / (edges_.wa[k] + edges_.wb[k]);
        const double change =
            -mass * hardness_ * (way + rate_ * (length_[k] - edges_.rest_length[k])) -
            give_ * impulse_[k];
        impulse_[k] += change;
        pull(k, change, x);
      }
    work_.edge_projections += std::int64_t{passes_} * edges_.count();
    phases_.filter += stopwatch();
    return {Status::ok, passes_};
  }

  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override {
    v = (x - start.x) * (1 / h);
    directions(x);
    for (int pass = 0; pass < passes_; ++pass)
      for (int k = 0; k < edges_.count(); ++k) {
        const double rate = n_.col(k).dot(v.col(edges_.b[k]) - v.col(edges_.a[k]));
        const double change = -rate / (edges_.wa[k] + edges_.wb[k]);
        impulse_[k] += h * change;
        pull(k, change, v);
      }
    work_.edge_projections += std::int64_t{passes_} * edges_.count();
    if (std::isfinite(v.sum())) last_force_ = impulse_ / (h * h);
    return {};
  }

  void directions(const Positions& x) {
    for (int k = 0; k < edges_.count(); ++k) {
      n_.col(k) = x.col(edges_.b[k]) - x.col(edges_.a[k]);
      length_[k] = n_.col(k).norm();
      if (length_[k] > 0) n_.col(k) /= length_[k];
    }
  }

  // A pinned end is not written to: adding 0 would make -0 of it.
  void pull(int k, double impulse, Positions& x) const {
    if (edges_.wa[k] > 0) x.col(edges_.a[k]) -= edges_.wa[k] * impulse * n_.col(k);
    if (edges_.wb[k] > 0) x.col(edges_.b[k]) += edges_.wb[k] * impulse * n_.col(k);
  }

  int passes_;
  double hardness_, give_, rate_;  // massScale, impulseScale and h times bias of the source
  EdgeConstraints edges_;
  std::unique_ptr<ImplicitForces> implicit_;  // null: explicit
  Eigen::Matrix3Xd n_;                        // of the edges; 0 where one has no length
  Eigen::VectorXd length_;                    // m, at n_
  Eigen::VectorXd impulse_;                   // of this step, kg m: h times impulse
  Eigen::VectorXd last_force_;                // of the last accepted step, N
};

}  // namespace

Backend soft_step_row() {
  return {.name = "soft_step",
          .summary = "velocities by Gauss-Seidel, positions by soft springs: small steps do it",
          .strain_control = StrainControl::time_step,
          .settings = {{"passes", 1.0, "Gauss-Seidel passes of either stage", at_least_one,
                        SearchRange{1, 8}},
                       {"frequency", 0.25, "of an edge's spring, in 1 / step", positive,
                        SearchRange{0.05, 1}},
                       {"damping", 10.0, "ratio of an edge's spring, 1: critical", positive,
                        SearchRange{1, 20}}},
          .make = make_step<SoftStep>,
          .direction = Direction::start,
          .citation = "Catto 2024",
          .origin = Origin::literature,
          .label = "soft step (TGS)",
          .takes_collider = false};
}

}  // namespace inextensible
