// Projective dynamics (Liu et al. 2013, Bouaziz et al. 2014) with hard lengths, as ADMM (Narain,
// Overby and Brown 2016): each edge is brought to its length by itself, and a constant linear
// system, factored once, makes vertices follow.
//
// The step minimizes 1/2 |x - x0|_M^2 with |z_k| = l_k for z_k = x_b - x_a, by the alternating
// direction method of multipliers with weights r_k (kg; D: the differences x_b - x_a):
//   (M + D^T r D) x = M x0 + D^T r (z - u),
//   z_k = l_k (D x + u)_k / |(D x + u)_k|,   u += D x - z,
// over-relaxed with alpha D x + (1 - alpha) z in place of D x (Eckstein and Bertsekas 1992). Its
// fixed points are those of ICD (Goldenthal et al. 2007), r u = h^2 times an edge's force. r is at
// the inertia's scale, so that the matrix does not depend on h. A step starts from the last
// accepted one's forces. Linear momentum is conserved by each iterate, angular momentum as far as
// the iteration has converged, since u turns towards its edge as z does.
//
// With contact inside, a vertex that touches is one more term, z_v = x_v within its half-space, and
// the others pull towards where they are, so that the matrix stays. Loops: three solves, one pass
// over edges, an iteration.
#include "solvers/methods/rows.h"
#include "solvers/systems/constraint_system.h"
#include "solvers/systems/vertex_matrix.h"

namespace inextensible {
namespace {

constexpr double contact_weight = 1;  // of a vertex's own term, times its mass

Pairs ends_of(const Problem& problem) {
  Pairs pairs;
  for (const auto [a, b] : problem.edges()) pairs.emplace_back(a, b);
  return pairs;
}

class Admm final : public VelocityFilter {
 public:
  Admm(const Problem& problem, const BackendOptions& options)
      : problem_(problem),
        edges_(problem, options.strain_limit),
        max_iterations_(options.count("max_iterations")),
        relaxation_(options.number("relaxation")),
        most_(options.number("direction_tolerance") * options.strain_limit /
              options.number("penalty")),
        most_push_(options.number("direction_tolerance") * options.strain_limit *
                   problem.shortest_rest_length()),
        shortest_(std::max(1 - options.number("target") * options.strain_limit, 0.0)),
        longest_(1 + options.number("target") * options.strain_limit),
        matrix_(problem, ends_of(problem), "auto", 1),
        target_(3, problem.vertices()) {
    for (const auto [a, b] : problem.edges())
      weight_.push_back(options.number("penalty") /
                        (problem.inverse_mass()[a] + problem.inverse_mass()[b]));
    rhs_.setZero(4, static_cast<Eigen::Index>(matrix_.vertex.size()));
    if (problem.contact_inside()) anchor_.resize(3, problem.vertices());
    z_.resize(3, problem.constraints());
    u_.resize(3, problem.constraints());
    last_u_.setZero(3, problem.constraints());
  }

  StepResult apply(const Positions& /*x_start*/, double h, Iterate x, WorkCounters& work) override {
    if (edges_.permissible(x)) return {Status::ok, 0};
    if (!factor(work)) return refuse(Status::singular, 0, edges_, x, "the matrix is singular");
    x.without_pushes(target_);
    start(h, x);
    for (int j = 1; j <= max_iterations_; ++j) {
      solve(x, work);
      const bool edges_rest = project_edges(x), vertices_rest = project_vertices(x);
      if (edges_rest && vertices_rest && ends(x)) {
        last_u_ = u_ / (h * h);
        return {Status::ok, j};
      }
      if (j % 64 == 0 && !x.positions().allFinite())
        return refuse(Status::not_converged, j, edges_, x, "overflow");
    }
    return refuse(Status::not_converged, max_iterations_, edges_, x, "iteration limit");
  }

  const char* linear_solver() const override { return matrix_.linear_solver.c_str(); }

 private:
  // M + D^T r D, once.
  bool factor(WorkCounters& work) {
    if (factored_) return true;
    double* value = matrix_.solver->values();
    std::fill(value, value + matrix_.pattern.entries(), 0.0);
    const auto add = [&](int f, int g, double number) {
      if (f >= 0 && g >= 0) value[matrix_.pattern.place(f, g)] += number;
    };
    const double scale = problem_.contact_inside() ? 1 + contact_weight : 1;
    for (std::size_t f = 0; f < matrix_.vertex.size(); ++f) {
      const int i = static_cast<int>(f);
      add(i, i, scale * problem_.mass()[matrix_.vertex[f]]);
    }
    for (int k = 0; k < problem_.constraints(); ++k) {
      const int a = matrix_.place[problem_.edges()[k].a], b = matrix_.place[problem_.edges()[k].b];
      add(a, a, weight_[k]);
      add(b, b, weight_[k]);
      add(a, b, -weight_[k]);
    }
    ++work.assemblies;
    return factored_ = factor_counted(*matrix_.solver, work);
  }

  // u from the last accepted step's forces, and x where these would take the candidate.
  void start(double h, Iterate iterate) {
    Positions& x = iterate;
    u_ = h * h * last_u_;
    for (int k = 0; k < edges_.count(); ++k) {
      const Eigen::Vector3d force = weight_[k] * u_.col(k);
      if (edges_.wa[k] > 0) x.col(edges_.a[k]) += edges_.wa[k] * force;
      if (edges_.wb[k] > 0) x.col(edges_.b[k]) -= edges_.wb[k] * force;
    }
    z_.setZero();
    for (int k = 0; k < edges_.count(); ++k)
      project_edge(k, x.col(edges_.b[k]) - x.col(edges_.a[k]) + u_.col(k));
    project_vertices(iterate);
  }

  // z_k towards x_b - x_a + u_k. Without a direction it keeps the one that it had.
  void project_edge(int k, const Eigen::Vector3d& sum) {
    const double l = edges_.rest_length[k], norm = sum.norm();
    if (norm > 0) z_.col(k) = std::clamp(norm, shortest_ * l, longest_ * l) / norm * sum;
  }

  // z and u; whether all edges of x keep the limit, and z has come to rest.
  bool project_edges(const Positions& x) {
    int violations = 0;
    for (int k = 0; k < edges_.count(); ++k) {
      const Eigen::Vector3d d = x.col(edges_.b[k]) - x.col(edges_.a[k]), before = z_.col(k),
                            sum = d + (relaxation_ - 1) * (d - before) + u_.col(k);
      const double l = edges_.rest_length[k], square = d.squaredNorm() / (l * l);
      project_edge(k, sum);
      u_.col(k) = sum - z_.col(k);
      const bool fits = square >= edges_.permissible_low && square <= edges_.permissible_high;
      const bool rests = (z_.col(k) - before).squaredNorm() <= most_ * most_ * l * l;
      violations += fits && rests ? 0 : 1;
    }
    return violations == 0;
  }

  // anchor_ and contacts' pushes: u_v = -push / contact_weight along the normal. Whether pushes
  // have come to rest.
  bool project_vertices(Iterate x) {
    Contacts* contacts = x.contacts();
    if (!contacts) return true;
    const Contacts::Timing measured = contacts->timing();
    bool rest = true;
    anchor_ = x.positions();
    for (int c = 0; c < contacts->count(); ++c) {
      const Eigen::Vector3d normal = contacts->normal(c);
      const double before = contacts->push(c);
      auto at = anchor_.col(contacts->vertex(c));
      at -= before / contact_weight * normal;
      const double gap = std::min(0.0, contacts->gap(c, at)), push = -contact_weight * gap;
      contacts->set_push(c, push);
      at -= 2 * gap * normal;
      rest &= std::abs(push - before) <= most_push_;
    }
    return rest;
  }

  void solve(Positions& x, WorkCounters& work) {
    for (std::size_t f = 0; f < matrix_.vertex.size(); ++f) {
      const int v = matrix_.vertex[f];
      auto force = rhs_.col(static_cast<Eigen::Index>(f)).head<3>();
      force = problem_.mass()[v] * target_.col(v);
      if (problem_.contact_inside()) force += contact_weight * problem_.mass()[v] * anchor_.col(v);
    }
    for (int k = 0; k < edges_.count(); ++k) {
      const int a = matrix_.place[edges_.a[k]], b = matrix_.place[edges_.b[k]];
      Eigen::Vector3d pull = weight_[k] * (z_.col(k) - u_.col(k));
      if (a < 0) pull += weight_[k] * x.col(edges_.a[k]);
      if (b < 0) pull -= weight_[k] * x.col(edges_.b[k]);
      if (a >= 0) rhs_.col(a).head<3>() -= pull;
      if (b >= 0) rhs_.col(b).head<3>() += pull;
    }
    matrix_.solver->solve_coordinates(rhs_);
    work.back_solves += 3;
    for (std::size_t f = 0; f < matrix_.vertex.size(); ++f)
      x.col(matrix_.vertex[f]) = rhs_.col(static_cast<Eigen::Index>(f)).head<3>();
  }

  // Moves vertices out of the obstacle; returns whether edges are still within the limit.
  bool ends(Iterate x) const {
    const Contacts* contacts = x.contacts();
    for (int c = 0; c < x.contact_count(); ++c) {
      auto at = x.positions().col(contacts->vertex(c));
      at -= std::min(0.0, contacts->gap(c, at)) * contacts->normal(c);
    }
    return edges_.permissible(x);
  }

  const Problem& problem_;
  EdgeConstraints edges_;
  int max_iterations_;
  double relaxation_;
  double most_;                 // that z moves in the last iteration, in rest lengths
  double most_push_;            // m, by which a contact's push changes in it
  double shortest_, longest_;   // that an edge is brought to, in rest lengths
  std::vector<double> weight_;  // of edges, kg
  VertexMatrix matrix_;
  bool factored_ = false;
  Eigen::Matrix4Xd rhs_;             // by free vertex
  Positions target_;                 // the candidate without what planes pushed it
  Positions anchor_;                 // z - u of vertices, with contact inside only
  Eigen::Matrix3Xd z_, u_, last_u_;  // of edges; last_u_: u / h^2 of the last accepted step
};

}  // namespace

Backend admm_row() {
  return {
      .name = "admm",
      .summary = "hard lengths by ADMM: single edges, then one constant linear system",
      .settings =
          {iteration_limit(1e5, "iterations a step before it is refused"),
           projection_target(),
           {"penalty", 10.0, "weight of an edge over that of its ends' inertia", positive,
            SearchRange{3, 100}},
           {"relaxation", 1.0, "alpha, of the edges' differences", relaxation_range,
            SearchRange{1, 1.9}},
           // The part of the forces on vertices that edges do not yet account for.
           {"direction_tolerance", 1.0,
            "last move of an edge's projection, times penalty, in strain limit times rest length",
            positive, tunable_direction_tolerance}},
      .make_filter = make_filter<Admm>,
      .direction = Direction::end,
      .citation = "Liu et al. 2013; Narain, Overby and Brown 2016",
      .origin = Origin::literature,
      .label = "projective dynamics (ADMM)",
      .conserves_momentum = false};
}

}  // namespace inextensible
