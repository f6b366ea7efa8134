// Implicit stiff springs (Baraff and Witkin 1998 and their kin): backward Euler with stretching as
// springs.
//
// Edge k has stiffness EA / l_k, so strain = tension / EA at any resolution. The method has no
// strain limit of its own: EA is its knob, and the harness finds the one that keeps a run within
// the limit.
#pragma once

#include <array>
#include <string>

#include "solvers/linear/spd_solver.h"
#include "solvers/methods/setting_fields.h"

namespace inextensible {

class ImplicitSprings final : public Stepper {
 public:
  struct Settings {
    double stiffness = 1e4;      // EA, N
    double strain_limit = 0.01;  // only sets the accuracy of Newton's iteration
    int max_iterations = 300;
    // Newton stops when its step moves no vertex by more than this times strain_limit times the
    // shortest rest length.
    double newton_tolerance = 0.1;
    // Instructions at 1 % strain and 1/100 s, plain Newton = 1, on the chain of 80 and the drape of
    // 21 x 21: start and tension take 0.66 and 0.77, with reuse 0.59 and 0.55. A reuse of 30 takes
    // 0.55 and 0.53 but ends steps less exactly on the chain.
    std::string_view start = "extrapolated";
    std::string_view tension = "linearized";
    double reuse = 10;
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  ImplicitSprings(std::shared_ptr<const Problem> problem, const Settings& settings);
  const char* linear_solver() const override { return linear_solver_.c_str(); }
  double reciprocal_condition() const override { return solver_->reciprocal_condition(); }

 private:
  StepResult solve(const State& state, double h, Positions& x) override;
  bool put_on_planes(Positions& x);
  bool release_pulled();
  StepResult newton(double h, double current, Positions& x);
  double energy(const Positions& x, double h) const;
  void assemble(const Positions& x, double h, bool matrix);
  void assemble_bending(const Positions& x, double h, bool matrix);
  void hold_in_planes(bool matrix);
  double start(const State& state, double h, Positions& x);
  void predict_tension(const Positions& x, const Positions& to);
  enum class Search { full, shortened, at_minimum, failed };
  Search search(const Positions& x, double h, double longest, double& current);
  StepResult end_velocities(const State& before, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;

  struct Spring {
    int a, b;         // vertices
    int fa, fb;       // their places among the free vertices in elimination order, -1 if pinned
    double rest, k;   // m, N/m
    int coupling[3];  // where each column of the coupling block begins among the matrix's values
  };
  std::string linear_solver_;
  int max_iterations_;
  double step_tolerance_;  // m
  double reuse_below_;     // m
  bool extrapolates_, predicts_tension_;
  std::vector<Spring> springs_;
  struct Hinge {                                 // a bending stencil's places
    std::array<int, 4> f;                        // among the free vertices, -1 if pinned
    std::array<std::array<int, 3>, 6> coupling;  // of the pairs 10, 20, 21, 30, 31, 32
  };
  std::vector<Hinge> hinges_;
  std::vector<int> free_vertex_;  // in elimination order
  std::vector<double> free_mass_;
  struct Places {  // of a diagonal block's numbers among the matrix's values
    int xx, xy, yy, xz, yz, zz;
  };
  std::vector<Places> diagonal_;  // one a free vertex
  std::size_t entries_ = 0;
  std::unique_ptr<SpdSolver> solver_;
  Positions inertial_, trial_;  // x + h v + h^2 g, and a line search's positions
  Positions ahead_;             // where history leads
  Positions before_;            // x^n, with drag only
  // With contact inside only: the place of each vertex among the free, and n . gradient of each
  // contact, J s^2 / m / kg: what its plane bears.
  std::vector<int> free_place_;
  std::vector<double> reaction_;
  enum class Release : char { never, once };
  std::vector<Release> released_;  // of each contact, in this step
  Eigen::VectorXd gradient_, step_;
  std::vector<double> pull_, pull_before_;  // N/m, predicted tension over length; the last step's
  Positions v_before_;                      // v^{n-1}
  double h_before_ = 0;                     // s; 0: no step yet
};

Backend implicit_springs_row();

}  // namespace inextensible
