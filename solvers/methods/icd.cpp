// Implicit constraint direction (Goldenthal et al. 2007, section 4.1): constraint forces act along
// J at the end of the step. (2) and (4) are theirs.
//
// Newton on F(dx, lambda) = dx + h^2 W J(x0 + dx)^T lambda = 0 and C(x0 + dx) = 0 together, mu =
// h^2 lambda:
//   [ M + H(mu)  J^T ] [ p ]   [ M dx + J^T mu ]
//   [ J           0  ] [ q ] = [ C             ] ,   dx -= p, mu -= q.
// Globalization (Nocedal and Wright 2006, chapter 18): where M + H is indefinite on the
// constraints' null space, negative multipliers are left out of H; a step is backtracked until
// either the residual |F|^2 + |C|^2 or the exact penalty 1/2 |dx|_M^2 + nu |C|_1, whose minimum is
// the closest point of Theorem 1, falls enough. Multipliers start from the last accepted step's
// forces; if that fails, once more from zero, whose first iteration is fast projection's. The
// linear system is solved to a few percent by projected conjugate gradients, or factored. Loops:
// one assembly, one factorization, several solves and one or more evaluations an iteration.
#include "solvers/methods/rows.h"
#include "solvers/systems/constraint_system.h"
#include "solvers/systems/kkt_system.h"

namespace inextensible {
namespace {

constexpr int line_search_limit = 12;
constexpr int most_rounds = 20;
constexpr double sufficient_decrease = 1e-4;
constexpr const char *projected_cg = "projected_cg", *block_tridiagonal = "block_tridiagonal";

// Without fill, as on trees, factoring the saddle-point matrix is cheaper than any iteration; and
// where it is small it costs little, and a full Newton step leaves less of F than is asked for.
// Chains have a factorization of their own.
constexpr int many_edges = 600;
std::string choose(std::string_view wanted, const Problem& problem) {
  if (wanted != "auto") return std::string(wanted);
  if (problem.contact_inside()) return projected_cg;
  if (forms_chains(problem)) return block_tridiagonal;
  const bool fill = problem.constraints() >= problem.vertices();
  return fill && problem.constraints() >= many_edges ? projected_cg : "quasi_definite";
}

std::unique_ptr<KktSolver> make_kkt_solver(std::string_view name, const Problem& problem,
                                           const EdgeConstraints& edges, double cg_tolerance) {
  if (name == projected_cg) return make_projected_cg(problem, edges, {cg_tolerance});
  if (name == block_tridiagonal) return make_chain_kkt(problem, edges);
  return make_kkt_system(problem, edges);
}

// The active set of contacts around an equation solver (Nocedal and Wright 2006, section 16.5).
// Vertices that planes hold stay on them while positions are solved for. Then a plane that would
// pull releases its vertex, one that was crossed holds it, and the rest is solved for again.
class ActiveContacts {
 public:
  explicit ActiveContacts(const Problem& problem) {
    if (!problem.contact_inside()) return;
    free_.resize(3, problem.vertices());
    reaction_.resize(problem.vertices());
  }

  // At the candidate x0 (3 x n), whose contacts are settled.
  void begin(Iterate x0) {
    contacts_ = x0.contact_count() > 0 ? x0.contacts() : nullptr;
    if (contacts_) x0.without_pushes(free_);
  }

  // The candidate, with its held vertices on their planes, to x.
  void write_candidate(Positions& x) const {
    if (!contacts_) return;
    x = free_;
    hold(x);
  }

  // Held vertices of x, onto their planes.
  void hold(Positions& x) const {
    if (!contacts_) return;
    const Contacts::Timing measured = contacts_->timing();
    for (int c = 0; c < contacts_->count(); ++c) {
      auto at = x.col(contacts_->vertex(c));
      if (contacts_->holds(c)) at -= contacts_->gap(c, at) * contacts_->normal(c);
    }
  }

  // Removes the reactions of planes, along the normals of held vertices, from the residual f (3 x
  // n) of equations scaled by these masses, and stores them.
  void take_reactions(const Eigen::VectorXd& mass, Positions& f) {
    if (!contacts_) return;
    for (int c = 0; c < contacts_->count(); ++c) {
      const int vertex = contacts_->vertex(c);
      const Eigen::Vector3d normal = contacts_->normal(c);
      const double reaction = contacts_->holds(c) ? normal.dot(f.col(vertex)) : 0;
      reaction_[c] = reaction / mass[vertex];
      f.col(vertex) -= reaction * normal;
    }
  }

  // At a solution x, after take_reactions(): releases planes that would pull, holds with those that
  // were crossed, and updates pushes. Returns whether other vertices are held now.
  bool update(const Positions& x) {
    if (!contacts_) return false;
    const Contacts::Timing measured = contacts_->timing();
    bool changed = false;
    for (int c = 0; c < contacts_->count(); ++c) {
      const int vertex = contacts_->vertex(c);
      if (contacts_->holds(c)) {
        const double push = reaction_[c] - contacts_->gap(c, free_.col(vertex));
        contacts_->set_push(c, std::max(push, 0.0));
        changed |= push < 0;
      } else if (const double gap = contacts_->gap(c, x.col(vertex));
                 gap < -contacts_->tolerance()) {
        contacts_->set_push(c, -gap);
        changed = true;
      }
    }
    return changed;
  }

 private:
  Contacts* contacts_ = nullptr;
  Positions free_;                // the candidate without any push
  std::vector<double> reaction_;  // of each contact, along its normal, over the vertex's mass, m
};

class Icd final : public VelocityFilter {
 public:
  Icd(const Problem& problem, const BackendOptions& options)
      : problem_(problem),
        linear_solver_(choose(options.word("linear_solver"), problem)),
        edges_(problem, options.strain_limit,
               linear_solver_ == projected_cg ? elimination_order(problem) : std::vector<int>{}),
        kkt_(make_kkt_solver(linear_solver_, problem, edges_, options.number("cg_tolerance"))),
        max_iterations_(options.count("max_iterations")),
        min_iterations_(options.count("min_iterations")),
        target_(options.number("target")),
        direction_tolerance_(options.number("direction_tolerance") * options.strain_limit *
                             problem.shortest_rest_length()),
        mass_(Eigen::Map<const Eigen::VectorXd>(problem.mass().data(), problem.vertices()) /
              problem.total_mass() * problem.vertices()),
        active_(problem) {
    for (Positions* p : {&x0_, &trial_, &dx_, &trial_dx_, &f_, &dp_})
      p->resize(3, problem.vertices());
    u_.resize(3, problem.constraints());
    for (Eigen::VectorXd* v : {&c_, &mu_, &trial_mu_, &dq_}) v->resize(problem.constraints());
    previous_lambda_ = Eigen::VectorXd::Zero(problem.constraints());
  }

  StepResult apply(const Positions& /*x_start*/, double h, Iterate x, WorkCounters& work) override {
    // dx = 0 and lambda = 0 solve both equations as far as is asked.
    if (min_iterations_ == 0 && edges_.permissible(x)) return {Status::ok, 0};
    if (x.contact_count() > 0 && !kkt_->takes_contacts())
      return refuse(Status::not_converged, 0, edges_, x,
                    "this linear solver cannot hold contacts, projected_cg can");
    active_.begin(x);
    active_.write_candidate(x);
    x0_ = x;
    for (int round = 0, iterations = 0;; ++round) {
      StepResult result = closest(h, x, work);
      result.iterations = iterations += result.iterations;
      if (!result || !active_.update(x)) return result;
      if (round == most_rounds)
        return refuse(Status::not_converged, iterations, edges_, x,
                      "the set of contacts that hold keeps changing");
      active_.write_candidate(x0_);
      active_.hold(x);
    }
  }

  const char* linear_solver() const override { return linear_solver_.c_str(); }

 private:
  // u_, c_, f_, largest_f_ and merit_ at x0 + dx (in trial_) with multipliers trial_mu_.
  void evaluate(const Positions& dx) {
    permissible_ = edges_.linearize(trial_, u_, c_, target_);  // (4) and (2)
    f_ = dx * mass_.asDiagonal();                              // M times the F of section 4.1
    for (int k = 0; k < edges_.count(); ++k) {
      f_.col(edges_.a[k]) -= trial_mu_[k] * u_.col(k);
      f_.col(edges_.b[k]) += trial_mu_[k] * u_.col(k);
    }
    for (const int vertex : problem_.pinned()) f_.col(vertex).setZero();
    active_.take_reactions(mass_, f_);
    double sum = 0, largest = 0;
    for (Eigen::Index v = 0; v < f_.cols(); ++v) {
      const double squared = f_.col(v).squaredNorm() / (mass_[v] * mass_[v]);
      sum += squared;
      if (!(squared <= largest)) largest = squared;
    }
    largest_f_ = std::sqrt(largest);
    merit_ = sum + c_.squaredNorm();
  }

  StepResult closest(double h, Iterate x, WorkCounters& work) {
    mu_ = previous_lambda_ * (h * h);
    StepResult result = newton(h, x, work);
    if (!result && previous_lambda_.squaredNorm() > 0) {
      const int spent = result.iterations;
      x.positions() = x0_;
      mu_.setZero();
      result = newton(h, x, work);
      result.iterations += spent;
    }
    return result;
  }

  bool direction(const Contacts* contacts, bool convex, WorkCounters& work) {
    return kkt_->factor(u_, mu_, contacts, convex, work) && kkt_->solve(f_, c_, dp_, dq_, work);
  }

  // Leaves the accepted step in trial_dx_, trial_mu_ and trial_.
  bool line_search(WorkCounters& work) {
    const double merit = merit_;
    const double nu = 2 * (mu_ - dq_).cwiseAbs().maxCoeff();
    const auto penalty = [&](const Positions& dx) {
      return 0.5 * dx.colwise().squaredNorm().dot(mass_) + nu * c_.cwiseAbs().sum();
    };
    const double penalty_here = penalty(dx_);
    const double slope =
        -(dx_.cwiseProduct(dp_).colwise().sum()).dot(mass_) - nu * c_.cwiseAbs().sum();
    double step = 1;
    for (int halvings = 0; halvings <= line_search_limit; ++halvings, step *= 0.5) {
      trial_dx_ = dx_ - step * dp_;
      trial_ = x0_ + trial_dx_;
      trial_mu_ = mu_ - step * dq_;
      evaluate(trial_dx_);
      if (merit_ <= (1 - 2 * sufficient_decrease * step) * merit) return true;  // false on NaN
      if (slope < 0 && penalty(trial_dx_) <= penalty_here + sufficient_decrease * step * slope)
        return true;
      ++work.line_search_steps;
    }
    return false;
  }

  StepResult newton(double h, Iterate x, WorkCounters& work) {
    trial_ = x;
    dx_ = trial_ - x0_;
    trial_mu_ = mu_;
    evaluate(dx_);
    for (int j = 0;; ++j) {
      const bool solved = permissible_ && largest_f_ <= direction_tolerance_;
      const auto accept = [&] {
        previous_lambda_ = mu_ / (h * h);
        return StepResult{Status::ok, j};
      };
      if (solved && (j >= min_iterations_ || merit_ == 0)) return accept();
      if (j == max_iterations_)
        return refuse(Status::not_converged, j, edges_, trial_, "iteration limit");
      if (!direction(x.contacts(), false, work)) {
        if (solved) return accept();
        return refuse(Status::singular, j, edges_, trial_, "the Newton matrix is singular");
      }
      if (!line_search(work)) {
        // Once more with the convex matrix; evaluate() restores what the search overwrote.
        const bool was_convex = kkt_->convexified();
        trial_ = x0_ + dx_;
        trial_mu_ = mu_;
        evaluate(dx_);
        if (solved)
          return accept();  // rounding stops iterations that only min_iterations asked for
        if (was_convex || !direction(x.contacts(), true, work) || !line_search(work))
          return refuse(Status::not_converged, j, edges_, trial_,
                        "no step along Newton's direction makes progress");
      }
      dx_.swap(trial_dx_);
      mu_.swap(trial_mu_);
      x.positions() = trial_;
    }
  }

  const Problem& problem_;
  std::string linear_solver_;
  EdgeConstraints edges_;
  std::unique_ptr<KktSolver> kkt_;
  int max_iterations_, min_iterations_;
  double target_;
  double direction_tolerance_;  // m
  Eigen::VectorXd mass_;        // scaled by the mean mass, as mu is
  ActiveContacts active_;

  Positions x0_, trial_, dx_, trial_dx_, f_, dp_;  // f_ = M F = M dx + J^T mu
  Eigen::Matrix3Xd u_;
  Eigen::VectorXd c_, mu_, trial_mu_, dq_;  // c_: what of C lies beyond the target
  bool permissible_ = false;
  double largest_f_ = 0;             // m, over vertices
  double merit_ = 0;                 // sum of |F|^2 and C^2, m^2
  Eigen::VectorXd previous_lambda_;  // mu / h^2 of the last solve that converged
};

}  // namespace

Backend icd_row() {
  return {
      .name = "icd",
      .summary = "Lagrange multipliers, constraint directions from the end of the step",
      .settings = {iteration_limit(200, "iterations a step before it is refused"),
                   least_iterations(),
                   projection_target(),
                   {"direction_tolerance", 0.1,
                    "largest |F| of a vertex, in strain limit times shortest rest length; above 1 "
                    "the direction may be that of an iterate short of the end",
                    positive, tunable_direction_tolerance},
                   {"cg_tolerance", 0.03, "accuracy of a Newton step by projected_cg",
                    forcing_range, SearchRange{0.001, 0.95}},
                   word_setting("linear_solver", "auto", "of the KKT system",
                                {"auto", "projected_cg", "quasi_definite", "block_tridiagonal"})},
      .make_filter = make_filter<Icd>,
      .direction = Direction::end,
      .citation = "Goldenthal et al. 2007",
      .origin = Origin::paper,
      .label = "ICD (implicit constraint direction)"};
}

}  // namespace inextensible
