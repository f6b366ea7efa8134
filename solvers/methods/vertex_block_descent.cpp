// Vertex block descent (Chen, Liu, Yang and Yuksel 2024): the implicit springs' energy, backward
// Euler's, lowered by a given number of passes that move one vertex at a time, x_i += H_i^-1 f_i.
// It has no strain limit of its own. Since the passes stop short of the minimum, springs behave as
// if they were softer than requested.
//
// A spring's negative stiffness across its direction is dropped, as implicit_springs does: the
// paper's Hessian is indefinite under compression. No line search, as in the paper. Momentum is
// conserved only as far as the iteration has converged. A vertex in contact takes the minimum
// within its plane. Loops: one over vertices a pass.
#include "solvers/methods/rows.h"
#include "solvers/methods/vertex_passes.h"
#include "solvers/problem/forces.h"

namespace inextensible {
namespace {

constexpr int most_contact_rounds = 30;

Springs all_springs(const Problem& problem, double stiffness) {
  Springs all = problem.shear() ? *problem.shear() : Springs{};
  for (int k = 0; k < problem.constraints(); ++k) {
    all.edges.push_back(problem.edges()[k]);
    all.rest_length.push_back(problem.rest_length()[k]);
    all.stiffness.push_back(stiffness / problem.rest_length()[k]);
  }
  return all;
}

class VertexBlockDescent final : public Stepper {
 public:
  VertexBlockDescent(std::shared_ptr<const Problem> shared, const BackendOptions& options)
      : Stepper(std::move(shared)),
        iterations_(options.count("iterations")),
        relaxation_(options.number("relaxation")),
        passes_(problem(), all_springs(problem(), options.number("stiffness")),
                problem().bending()),
        inertial_(3, problem().vertices()),
        inertia_(problem().mass()),
        v_before_(3, problem().vertices()) {}

 private:
  StepResult solve(const State& state, double h, Positions& x) override {
    Stopwatch stopwatch(phases_wanted_);
    free_flight(problem(), state, h, h * h, inertial_);
    for (int v = 0; problem().has_drag() && v < problem().vertices(); ++v) {
      const double mass = problem().mass()[v], drag = h * problem().drag(v);
      inertia_[v] = mass + drag;
      inertial_.col(v) += drag / (mass + drag) * (state.x.col(v) - inertial_.col(v));
    }
    Contacts* contacts = contacts_inside();
    if (contacts) {
      contacts->apply_friction(inertial_, work_);
      contacts->find(inertial_, work_);
    }
    start(state, h, x);
    if (contacts) contacts->find(x, work_);
    passes_.load(x, inertial_, inertia_);
    StepResult result;
    for (int round = 0;; ++round) {
      passes_.set_planes(contacts);
      for (int i = 0; i < iterations_; ++i) passes_.visit_all(h * h, relaxation_);
      result.iterations += iterations_;
      work_.spring_evaluations += std::int64_t{iterations_} * passes_.entries();
      passes_.store(x);
      if (!passes_.finite())
        return {Status::not_finite, result.iterations, -1, 0, "a position overflowed"};
      if (!contacts) break;
      passes_.read_pushes(*contacts);
      if (contacts->find(x, work_) == 0) break;
      if (round == most_contact_rounds)
        return {Status::not_converged, result.iterations, -1, 0, "the contact set did not settle"};
    }
    phases_.unconstrained += stopwatch();
    return result;
  }

  // The paper's adaptive initialization: gravity counts as far as the last step's acceleration says
  // that nothing bears it; the first step starts from the free flight.
  void start(const State& state, double h, Positions& x) const {
    x = inertial_;
    const double gravity = problem().gravity().norm();
    const double since = state.time - time_before_;  // within BDF2 not the last step's length
    if (since <= 0 || gravity == 0) return;
    const Eigen::Vector3d down = problem().gravity() / gravity;
    for (int v = 0; v < problem().vertices(); ++v) {
      if (problem().inverse_mass()[v] == 0) continue;
      const double fall = down.dot(state.v.col(v) - v_before_.col(v)) / since;
      x.col(v) =
          state.x.col(v) + h * state.v.col(v) + h * h * std::clamp(fall, 0.0, gravity) * down;
    }
  }

  // The history is of accepted steps, so that one tried again after a refusal starts as it did.
  StepResult end_velocities(const State& before, double h, const Positions& x,
                            Positions& v) override {
    v_before_ = before.v;
    time_before_ = before.time;
    return Stepper::end_velocities(before, h, x, v);
  }

  int iterations_;
  double relaxation_;
  VertexPasses passes_;
  Positions inertial_;           // x + h v + h^2 g, drag's included
  std::vector<double> inertia_;  // m + h times drag, kg
  Positions v_before_;           // v^{n-1}
  double time_before_ = std::numeric_limits<double>::infinity();  // s, of v_before_
};

}  // namespace

Backend vertex_block_descent_row() {
  return {.name = "vertex_block_descent",
          .summary = "stiff springs, a number of passes over single vertices",
          .strain_control = StrainControl::stiffness,
          .settings =
              {{"stiffness", 1e4, "spring stiffness EA in N; sweeps search it", positive},
               {"iterations", 100.0, "passes over all vertices a step", at_least_one,
                SearchRange{5, 500}},
               {"relaxation", 1.0,
                "times a vertex's move; over-relaxed, where the paper has Chebyshev's acceleration",
                relaxation_range, tunable_relaxation}},
          .make = make_step<VertexBlockDescent>,
          .direction = Direction::springs,
          .citation = "Chen et al. 2024",
          .origin = Origin::literature,
          .label = "vertex block descent",
          .conserves_momentum = false,
          .backward_euler = true};
}

}  // namespace inextensible
