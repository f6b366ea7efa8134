// A = M + H is a scalar matrix, the same for x, y and z, and D, its diagonal, is near it where
// tensions are moderate. The saddle-point matrix with D in place of A is the preconditioner: its
// Schur complement J D^-1 J^T is factored like fast projection's J W J^T. From a p with J p = c on,
// all corrections lie in J's null space: the iteration is that of conjugate gradients for p alone,
// on A restricted to there, and the multipliers q fall out of the projections. Residuals lose their
// part along J^T at every step, lest they lose digits to it (section 6 of the paper).
//
// Newton's method needs no more than a few percent of accuracy. Where curvature d^T A d is not
// positive, A is indefinite on the null space, and the step so far is taken (Dembo and Steihaug
// 1983); if there is none yet, the convex H is. Where J D^-1 J^T is singular or conjugate gradients
// get nowhere, the factored saddle-point matrix takes over. Loops: one assembly and one
// factorization a Newton iteration; one solve and four passes over edges an iteration here.
#include "solvers/systems/constraint_system.h"
#include "solvers/systems/kkt_system.h"

namespace inextensible {
namespace {

// Tolerance of solves with J D^-1 J^T: the next Newton step corrects what one leaves of J p.
constexpr double projection_tolerance = 1e-4;

class ProjectedCg final : public KktSolver {
 public:
  ProjectedCg(const Problem& problem, const EdgeConstraints& edges,
              const ProjectedCgSettings& settings)
      : KktSolver(problem, edges),
        settings_(settings),
        schur_(edges, problem.vertices(), spd_solver(settings.linear_solver).triangle),
        solver_(make_spd_solver(settings.linear_solver, schur_.pattern())),
        mass_(Eigen::Map<const Eigen::VectorXd>(problem.mass().data(), problem.vertices()) /
              mean_mass_),
        curvature_(edges.count()),
        inverse_metric_(problem.vertices()),
        dq_(edges.count()) {
    solver_->set_least_pivot(ConstraintSystem::least_pivot);
    for (Positions* p : {&residual_, &direction_, &image_, &correction_})
      p->resize(3, problem.vertices());
  }

  bool takes_contacts() const override { return true; }

 private:
  enum class Outcome { converged, negative_curvature, failed };

  bool touches() const { return contacts_ && contacts_->count() > 0; }

  void set_curvature(bool convex) {
    convexified_ = convex;
    for (int k = 0; k < edges_.count(); ++k) curvature_[k] = curvature(k);
  }

  bool factor_itself(WorkCounters& work) override {
    set_curvature(convex_);
    // D: M and what tension adds to the diagonal.
    inverse_metric_ = mass_;
    for (int k = 0; k < edges_.count(); ++k) {
      const double tension = std::max(curvature_[k], 0.0);
      inverse_metric_[edges_.a[k]] += tension;
      inverse_metric_[edges_.b[k]] += tension;
    }
    inverse_metric_ = inverse_metric_.cwiseInverse();
    for (const int vertex : problem_.pinned()) inverse_metric_[vertex] = 0;
    schur_.weigh(inverse_metric_.data());
    schur_.assemble(*u_, solver_->values());
    if (touches()) schur_.subtract_contacts(*contacts_, *u_, *u_, solver_->values());
    ++work.assemblies;
    return factor_counted(*solver_, work);
  }

  // Knows no contacts: its steps may leave their planes.
  std::unique_ptr<KktSolver> make_other() const override {
    return make_kkt_system(problem_, edges_);
  }

  // r -= J^T q.
  void subtract_gradients(const Eigen::VectorXd& q, Positions& r) const {
    const double* u = u_->data();
    for (int k = 0; k < edges_.count(); ++k, u += 3) {
      const double qk = q[k];
      double *ra = r.data() + 3 * edges_.a[k], *rb = r.data() + 3 * edges_.b[k];
      for (int i = 0; i < 3; ++i) {
        ra[i] += qk * u[i];
        rb[i] -= qk * u[i];
      }
    }
  }

  // y = (M + H) p.
  void apply_hessian(const Positions& p, Positions& y) const {
    y = p * mass_.asDiagonal();
    for (int k = 0; k < edges_.count(); ++k) {
      const Eigen::Vector3d pull = curvature_[k] * (p.col(edges_.b[k]) - p.col(edges_.a[k]));
      y.col(edges_.a[k]) -= pull;
      y.col(edges_.b[k]) += pull;
    }
  }

  // [ D J^T; J 0 ] [ p; q ] = [ r; c ], c = 0 if there is none: q = (J D^-1 J^T)^-1 (J D^-1 r - c),
  // r -= J^T q, p = D^-1 r.
  bool precondition(Positions& r, const Eigen::VectorXd* c, Positions& p, Eigen::VectorXd& q,
                    WorkCounters& work) {
    p = r * inverse_metric_.asDiagonal();
    if (contacts_) contacts_->keep_in_planes(p);
    edges_.rate(*u_, p, q);
    if (c) q -= *c;
    ++work.back_solves;
    if (!solver_->solve_within(projection_tolerance, q.data())) return false;
    subtract_gradients(q, r);
    p = r * inverse_metric_.asDiagonal();
    if (contacts_) contacts_->keep_in_planes(p);
    return true;
  }

  bool solve_itself(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
                    WorkCounters& work) override {
    Outcome outcome = iterate(r, c, p, q, work);
    if (outcome == Outcome::negative_curvature) {
      set_curvature(true);
      outcome = iterate(r, c, p, q, work);
    }
    return outcome == Outcome::converged;
  }

  // Translations change no edge, so that p's share of them is known exactly: what is left of the
  // residual over the total mass. Linear momentum is kept to rounding this way.
  Outcome finish(Positions& p) const {
    if (problem_.pinned().empty() && !touches())
      p.colwise() += residual_.rowwise().sum() / mass_.sum();
    return Outcome::converged;
  }

  Outcome iterate(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
                  WorkCounters& work) {
    residual_ = r;
    if (!precondition(residual_, &c, p, q, work)) return Outcome::failed;
    apply_hessian(p, image_);
    residual_ -= image_;
    // |p|^2 in the norm of D.
    double size = 0;
    for (int v = 0; v < problem_.vertices(); ++v)
      if (inverse_metric_[v] > 0) size += p.col(v).squaredNorm() / inverse_metric_[v];
    const double goal = settings_.tolerance * settings_.tolerance * size;
    double error = 0;  // of the last iteration
    for (int i = 0;; ++i) {
      if (!precondition(residual_, nullptr, correction_, dq_, work)) return Outcome::failed;
      q += dq_;
      const double next_error = correction_.cwiseProduct(residual_).sum();
      if (next_error <= goal) return finish(p);
      if (!std::isfinite(next_error) || i == settings_.max_iterations) return Outcome::failed;
      if (i == 0) {
        direction_ = correction_;
      } else {
        direction_ = correction_ + (next_error / error) * direction_;
      }
      error = next_error;
      apply_hessian(direction_, image_);
      for (const int vertex : problem_.pinned()) image_.col(vertex).setZero();
      const double curvature = direction_.cwiseProduct(image_).sum();
      if (!(curvature > 0)) return i > 0 ? finish(p) : Outcome::negative_curvature;
      const double step = error / curvature;
      p += step * direction_;
      residual_ -= step * image_;
    }
  }

  ProjectedCgSettings settings_;
  SchurComplement schur_;  // J D^-1 J^T
  std::unique_ptr<SpdSolver> solver_;
  Eigen::VectorXd mass_;            // scaled by the mean mass
  Eigen::VectorXd curvature_;       // of H, an edge each
  Eigen::VectorXd inverse_metric_;  // D^-1, a vertex each
  Positions residual_, direction_, image_, correction_;
  Eigen::VectorXd dq_;
};

}  // namespace

std::unique_ptr<KktSolver> make_projected_cg(const Problem& problem, const EdgeConstraints& edges,
                                             const ProjectedCgSettings& settings) {
  return std::make_unique<ProjectedCg>(problem, edges, settings);
}

}  // namespace inextensible
