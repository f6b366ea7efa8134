// Projective dynamics (Liu et al. 2013, Bouaziz et al. 2014) with hard lengths, as ADMM (Narain,
// Overby and Brown 2016): each edge is brought to its length by itself, and a constant linear
// system, factored once, makes vertices follow.
#pragma once

#include <string>

#include "solvers/linear/spd_solver.h"
#include "solvers/methods/setting_fields.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class ProjectiveDynamics final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;
    double target = 0;    // of the strain limit; as FastProjection's
    double penalty = 10;  // weight of an edge, times 1 / (h^2 (w_a + w_b))
    double relaxation = 1;
    // A step ends when no edge's z moves by more than this times strain_limit times its length,
    // over the penalty: so much of what pulls at vertices is not yet what edges do.
    double direction_tolerance = 1;
    std::string_view linear_solver = "auto";  // tridiagonal on chains, else fixed_pattern
  };
  static SettingFields<Settings> fields();
  ProjectiveDynamics(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;
  const char* linear_solver() const override { return linear_solver_.c_str(); }
  double reciprocal_condition() const override { return solver_->reciprocal_condition(); }

 private:
  SymmetricPattern graph_of(const std::vector<int>& order, bool one_chain);
  void choose_solver(std::string_view wanted);
  bool factor(WorkCounters& work);
  void start(double h, Iterate x);
  void project_edge(int k, const Eigen::Vector3d& sum);
  bool project_edges(const Positions& x);
  bool project_vertices(Iterate x);
  void solve(Positions& x, WorkCounters& work);
  bool ends(Iterate x) const;

  const Problem& problem_;
  EdgeConstraints edges_;
  int max_iterations_;
  double relaxation_;
  double most_;                   // that z moves in the last iteration, in rest lengths
  double most_push_;              // m, by which a contact's push changes in it
  double shortest_, longest_;     // that an edge is brought to, in rest lengths
  std::vector<double> weight_;    // of edges, kg
  std::vector<int> free_vertex_;  // in elimination order
  std::vector<int> place_;        // of a vertex among them, -1: pinned
  SymmetricPattern pattern_;
  std::string linear_solver_;
  std::unique_ptr<SpdSolver> solver_;
  bool factored_ = false;
  Eigen::MatrixX3d rhs_;             // by free vertex
  Positions target_;                 // the candidate without what planes pushed it
  Positions anchor_;                 // z - u of vertices, with contact inside only
  Eigen::Matrix3Xd z_, u_, last_u_;  // of edges; last_u_: u / h^2 of the last accepted step
};

Backend projective_dynamics_row();

}  // namespace inextensible
