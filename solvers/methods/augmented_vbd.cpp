// Augmented vertex block descent (Giles, Diaz and Yuksel 2025) with hard lengths: the edges'
// multipliers are sought by the method of multipliers, and vertices moved one by one in between.
//
// An iteration is one pass over vertices with f_k = r_k C_k + mu_k along each edge, C_k = d_k -
// l_k, and mu_k += r_k C_k after it: the paper's hard constraints, mu = h^2 lambda. Departures: the
// penalty r_k stays at the inertia's scale, 1 / (w_a + w_b), so that passes converge; and all of C
// is corrected (the paper's alpha is 0), which leaves nothing for a stabilization. Iterated to the
// end, a step ends at the closest point of Goldenthal et al. 2007, Theorem 1.
//
// Multipliers start from the last accepted step's forces, and vertices from where these would take
// the candidate: what is at rest is solved before the first pass. Where that makes passes overflow,
// they begin once more at the candidate, without multipliers. Loops: two over vertices and the ends
// of their edges a pass.
#include "solvers/methods/rows.h"
#include "solvers/methods/vertex_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {
namespace {

Springs penalties(const Problem& problem, double penalty) {
  Springs springs{problem.edges(), problem.rest_length(), {}};
  for (const auto [a, b] : problem.edges())
    springs.stiffness.push_back(penalty / (problem.inverse_mass()[a] + problem.inverse_mass()[b]));
  return springs;
}

class AugmentedVbd final : public VelocityFilter {
 public:
  AugmentedVbd(const Problem& problem, const BackendOptions& options)
      : problem_(problem),
        edges_(problem, options.strain_limit),
        strain_limit_(options.strain_limit),
        max_iterations_(options.count("max_iterations")),
        most_(options.number("direction_tolerance") * options.strain_limit *
              problem.shortest_rest_length() / options.number("penalty")),
        passes_(problem, penalties(problem, options.number("penalty"))),
        target_(3, problem.vertices()),
        tension_(passes_.tensions()) {}

  StepResult apply(const Positions& /*x_start*/, double h, Iterate x, WorkCounters& work) override {
    if (edges_.permissible(x)) return {Status::ok, 0};
    x.without_pushes(target_);
    Contacts* contacts = x.contacts();
    passes_.load(x, target_, problem_.mass());
    passes_.set_planes(contacts);
    passes_.tensions() = h * h * tension_;
    passes_.follow_tensions();
    bool again = false;
    for (int j = 1; j <= max_iterations_; ++j) {
      const bool still = passes_.visit_all(1) <= most_ * most_;
      work.edge_projections += problem_.constraints();
      const bool ends = passes_.update_tensions(strain_limit_) && still;
      if (!ends && (j % 64 != 0 || passes_.finite())) continue;
      if (!ends && !again) {
        again = true;
        passes_.load(x, target_, problem_.mass());
        passes_.tensions().setZero();
        continue;
      }
      passes_.store(x);
      if (!edges_.permissible(x)) return refuse(Status::not_converged, j, edges_, x, "overflow");
      tension_ = passes_.tensions() / (h * h);
      if (contacts) passes_.read_pushes(*contacts);
      return {Status::ok, j};
    }
    passes_.store(x);
    return refuse(Status::not_converged, max_iterations_, edges_, x, "pass limit");
  }

 private:
  const Problem& problem_;
  EdgeConstraints edges_;
  double strain_limit_;
  int max_iterations_;
  double most_;  // m, that vertices move in the last pass
  VertexPasses passes_;
  Positions target_;        // the candidate without what planes pushed it
  Eigen::ArrayXd tension_;  // of the last accepted step, N, by the passes' entries
};

}  // namespace

Backend augmented_vbd_row() {
  return {.name = "augmented_vbd",
          .summary = "hard lengths by the method of multipliers, in passes over single vertices",
          .settings =
              {iteration_limit(1e5, "passes a step before it is refused"),
               {"penalty", 10.0, "stiffness of an edge over that of its ends' inertia", positive,
                SearchRange{1, 20}},
               // An edge answers a move of its ends by the penalty times that.
               {"direction_tolerance", 1.0,
                "last move of a vertex, times penalty, in strain limit times shortest rest length",
                positive, tunable_direction_tolerance}},
          .make_filter = make_filter<AugmentedVbd>,
          .direction = Direction::end,
          .citation = "Giles, Diaz and Yuksel 2025",
          .origin = Origin::literature,
          .label = "augmented VBD",
          .conserves_momentum = false};
}

}  // namespace inextensible
