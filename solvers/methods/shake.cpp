// SHAKE (Ryckaert, Ciccotti and Berendsen 1977) as a global Newton method: constraint forces act
// along the gradient at the start of the step, the matrix is built once a step and again only if
// convergence fails (Barth et al. 1994). RATTLE follows below.
//
// (5) and (7) are those of Goldenthal et al. 2007, which take J at x_j where SHAKE takes J(x^n).
//
// Newton on C(x0 - W J(x^n)^T h^2 lambda) = 0, with mu = h^2 dlambda. Its matrix J(x_j) W J(x^n)^T
// is replaced by J(x^n) W J(x^n)^T, symmetric and factored once a step; where that does not halve
// the constraint error, the true matrix at the best iterate so far is built, unsymmetric, and kept
// until it fails in turn. A step along its direction that does not lower the error is halved.
// The equations have spurious solutions far away; the closest point of the manifold is at most
// twice as far from x^n (on it) as x0 is, so what is farther, allowing for slack, is refused.
// Loops: one assembly and factorization a step, one solve and two passes over edges an iteration.
#include "solvers/methods/rows.h"
#include "solvers/problem/forces.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {
namespace {

constexpr double shortest_step = 1e-3;  // of Newton's
constexpr const char* no_solution =
    "the linear solver did not converge, or its multipliers grew too large";

class Shake final : public VelocityFilter {
 public:
  Shake(const Problem& problem, const BackendOptions& options)
      : system_(problem, options.strain_limit, options.word("linear_solver")),
        problem_(problem),
        slack_(options.strain_limit * problem.longest_rest_length() *
               std::sqrt(problem.total_mass())),
        max_iterations_(options.count("max_iterations")),
        min_iterations_(options.count("min_iterations")),
        target_(options.number("target")),
        u_start_(3, problem.constraints()),
        u_(3, problem.constraints()),
        c_(problem.constraints()),
        mu_(problem.constraints()),
        best_{Positions(3, problem.vertices()), {}} {}

  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    const EdgeConstraints& edges = system_.edges();
    Matrix matrix = Matrix::start;
    double least_error = 0;  // |C| at best_
    double full_step = 0;    // |mu_| before halving
    double reach = 0;        // largest |x^{n+1} - x^n| that is not taken for spurious
    for (int j = 0;; ++j) {
      const bool permissible = edges.linearize(x, u_, c_, target_);
      const double error = c_.norm();
      const bool exact = error == 0 && (target_ > 0 || j > 0);  // nothing is left to project
      if (permissible && (j >= min_iterations_ || exact)) {
        if (j > 0 && distance(x_start, x) > reach)
          return refuse(Status::not_converged, j, edges, x, "a spurious solution, far from x^n");
        return {Status::ok, j};
      }
      if (j == max_iterations_)
        return refuse(Status::not_converged, j, edges, x, "iteration limit");

      if (j == 0) {
        reach = edges.permissible(x_start) ? 2 * distance(x_start, x) + slack_
                                           : std::numeric_limits<double>::infinity();
        if (!factor_start(x_start, x.contacts(), work))
          return refuse(Status::singular, j, edges, x,
                        "J W J^T at the start of the step is not positive definite");
      } else if (error < 0.5 * least_error) {
        if (matrix == Matrix::here) matrix = Matrix::kept;
      } else if (matrix == Matrix::here && !(error < least_error)) {  // no decrease: half the step
        if (mu_.norm() < shortest_step * full_step)
          return refuse(Status::not_converged, j, edges, x,
                        "no step along J(x^n) lowers the constraint error");
        ++work.line_search_steps;
        mu_ *= 0.5;
        x.restore(best_);
        correct(x);
        continue;
      } else {
        if (!(error < least_error)) {
          x.restore(best_);
          edges.linearize(x, u_, c_, target_);
        }
        if (!factor_here(x.contacts(), work))
          return refuse(Status::singular, j, edges, x, "J(x_j) W J(x^n)^T is singular");
        matrix = Matrix::here;
      }
      least_error = c_.norm();
      x.save(best_);
      if (!solve(matrix, work)) return refuse(Status::singular, j, edges, x, no_solution);  // (7)
      full_step = mu_.norm();
      correct(x);  // (5)
    }
  }

  // RATTLE's velocity stage (Andersen 1983): v -= W J^T nu with J = J(x), so that J v = 0, and
  // nothing moves through a plane that holds it. Without contacts the factor is kept: a step that
  // starts at this x does not build it again. contacts: null, or those of this step.
  StepResult project_velocity(const Positions& x, const Contacts* contacts, Positions& v,
                              WorkCounters& work) {
    const EdgeConstraints& edges = system_.edges();
    if (!factor_start(x, contacts, work))
      return refuse(Status::singular, 0, edges, x,
                    "J W J^T at the end of the step is not positive definite");
    x_factored_ = x;
    factored_ = !contacts;  // which will be others in the next step
    if (contacts) contacts->keep_on_planes(x, v);
    edges.rate(u_start_, v, mu_);  // J v, of what planes leave
    if (!system_.solve(mu_, work)) return refuse(Status::singular, 0, edges, x, no_solution);
    edges.apply(u_start_, mu_, v);
    if (contacts) contacts->keep_on_planes(x, v);
    return {};
  }

  const char* linear_solver() const override { return system_.solver_name().c_str(); }

 private:
  // The matrix in (7): that of the start of the step; the true one, J(x_j) W J(x^n)^T, of this
  // iterate or of an earlier one.
  enum class Matrix { start, here, kept };
  // J(x_start) W J(x_start)^T, unless it is there already. False if it is not positive definite.
  bool factor_start(const Positions& x_start, const Contacts* contacts, WorkCounters& work) {
    if (factored_ && x_factored_ == x_start) return true;
    factored_ = false;
    system_.edges().gradient(x_start, u_start_);
    return system_.factor(u_start_, contacts, work);
  }

  bool factor_here(const Contacts* contacts, WorkCounters& work) {
    if (!current_) {
      current_ = std::make_unique<SchurComplement>(system_.edges(), problem_.vertices(),
                                                   SymmetricPattern::Triangle::both);
      current_solver_ = make_lu_solver(current_->pattern());
    }
    current_->assemble(u_, u_start_, current_solver_->values());
    if (contacts) current_->subtract_contacts(*contacts, u_, u_start_, current_solver_->values());
    ++work.assemblies;
    ++work.factorizations;
    return current_solver_->factor();
  }

  bool solve(Matrix matrix, WorkCounters& work) {
    mu_ = c_;
    if (matrix == Matrix::start) return system_.solve(mu_, work);  // (7) with J(x^n) on both sides
    current_solver_->solve(mu_.data());                            // (7) with J(x_j) W J(x^n)^T
    ++work.back_solves;
    return true;
  }

  void correct(Iterate x) {
    system_.edges().apply(u_start_, mu_, x);  // (5) with J(x^n)
    x.settle();
  }

  // |x - x_start| in the norm of M.
  double distance(const Positions& x_start, const Positions& x) const {
    double sum = 0;
    for (Eigen::Index v = 0; v < x.cols(); ++v)
      sum += problem_.mass()[v] * (x.col(v) - x_start.col(v)).squaredNorm();
    return std::sqrt(sum);
  }

  ConstraintSystem system_;
  const Problem& problem_;
  double slack_;  // M-norm of what the strain limit lets vertices drift
  int max_iterations_, min_iterations_;
  double target_;
  Eigen::Matrix3Xd u_start_, u_;
  Positions x_factored_;  // where the factor in system_ was built; used by RATTLE only
  bool factored_ = false;
  Eigen::VectorXd c_, mu_;  // what of C(x_j) lies beyond the target; the step's h^2 dlambda
  Iterate::Record best_;    // of least |C|
  // J(x_j) W J(x^n)^T, made at the first failure to converge: most runs never need it.
  std::unique_ptr<SchurComplement> current_;
  std::unique_ptr<DirectSolver> current_solver_;
};

// RATTLE (Andersen 1983): SHAKE's kin with velocities at the ends of steps. Second order,
// symmetric, hence without damping:
//   x^{n+1} = x^n + h v^n + h^2/2 (a(x^n) - W J(x^n)^T lambda)   with C(x^{n+1}) = 0  (SHAKE),
//   v^{n+1} = (x^{n+1} - x^n)/h + h/2 a(x^{n+1}) - W J(x^{n+1})^T nu   with J(x^{n+1}) v^{n+1} = 0.
// The matrix of the second line is SHAKE's in the next step: one factorization and two solves a
// step. Both lines take implicit forces in the middle of the step (Stern and Grinspun 2009).
class Rattle final : public Stepper {
 public:
  Rattle(std::shared_ptr<const Problem> problem, const BackendOptions& options)
      : Stepper(std::move(problem)), shake_(*problem_, options) {
    if (problem_->implicit_forces()) implicit_ = std::make_unique<ImplicitForces>(*problem_);
  }
  const char* linear_solver() const override { return shake_.linear_solver(); }

 private:
  StepResult solve(const State& state, double h, Positions& x) override {
    Stopwatch stopwatch(phases_wanted_);
    if (in_step(implicit_, h)) {  // position stage (Andersen 1983)
      if (!implicit_->advance_inside(state, h, 0.5, kick_, x, work_))
        return {Status::singular, 0, -1, 0, singular_forces};
      kick_ = (x - kick_) * (1 / h);
    } else {
      x = state.x + h * state.v;
      add_acceleration(*problem_, state.x, 0.5 * h * h, x, work_);
      if (problem_->has_drag()) add_drag(*problem_, state.v, 0.5 * h * h, x);
      for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
    }
    if (contacts_inside()) candidate_ = x;
    phases_.unconstrained += stopwatch();
    const StepResult result = apply_until_clear(shake_, contacts_inside(), state.x, h, x, work_);
    phases_.filter += stopwatch();
    return result;
  }

  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override {
    Stopwatch stopwatch(phases_wanted_);
    v = (x - start.x) * (1 / h);  // velocity stage
    if (in_step(implicit_, h)) {
      v += kick_;
      v.colwise() += 0.5 * h * problem_->gravity();
    } else {
      if (problem_->has_drag()) add_drag(*problem_, v, 0.5 * h, v);  // of the velocity halfway
      add_acceleration(*problem_, x, 0.5 * h, v, work_);
    }
    for (const int vertex : problem_->pinned())  // 0 unless pins follow a body
      v.col(vertex) = (x.col(vertex) - start.x.col(vertex)) * (1 / h);
    if (const Contacts* contacts = contacts_inside()) {  // which bear what presses on them
      const bool friction = contacts->candidate().size() > 0;
      for (int c = 0; c < contacts->count(); ++c) {
        if (!contacts->holds(c)) continue;
        const int i = contacts->vertex(c);
        if (friction) v.col(i) += (contacts->candidate().col(i) - candidate_.col(i)) * (1 / h);
        v.col(i) = contacts->end_velocity(c, (x.col(i) - start.x.col(i)) * (1 / h), v.col(i));
      }
    }
    phases_.unconstrained += stopwatch();
    const StepResult result = shake_.project_velocity(x, contacts_inside(), v, work_);
    phases_.filter += stopwatch();
    return result;
  }

  Shake shake_;
  std::unique_ptr<ImplicitForces> implicit_;  // null: explicit
  Positions candidate_;                       // before friction, with contact only
  Positions kick_;                            // m/s, of implicit forces in half a step
};

std::vector<SettingInfo> shake_settings(double min_iterations) {
  return {iteration_limit(50, "iterations a step before it is refused"),
          least_iterations(min_iterations), projection_target(), schur_solver()};
}

}  // namespace

Backend shake_row() {
  return {.name = "shake",
          .summary = "Lagrange multipliers, constraint directions from the start of the step",
          .settings = shake_settings(0),
          .make_filter = make_filter<Shake>,
          .direction = Direction::start,
          .citation = "Ryckaert, Ciccotti and Berendsen 1977; Barth et al. 1994",
          .origin = Origin::paper,
          .label = "SHAKE",
          .stepper = "verlet"};
}

Backend rattle_row() {
  return {.name = "rattle",
          .summary =
              "SHAKE with velocities projected as well (Andersen 1983): second order, no damping",
          .settings = shake_settings(1),
          .make = make_step<Rattle>,
          .direction = Direction::start,
          .citation = "Andersen 1983",
          .origin = Origin::literature,
          .label = "RATTLE (SHAKE with velocities)",
          .family = "shake",
          .velocities = Velocities::whole_step,
          .stepper = "verlet"};
}

}  // namespace inextensible
