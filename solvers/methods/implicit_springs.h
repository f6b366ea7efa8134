// Implicit stiff springs (Baraff and Witkin 1998 and their kin): backward Euler with stretching as
// springs.
//
// Edge k has stiffness EA / l_k, so strain = tension / EA at any resolution. The method has no
// strain limit of its own: EA controls the strain, and the harness finds the one that keeps a run
// within the limit.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "solvers/methods/backend.h"
#include "solvers/systems/vertex_matrix.h"

namespace inextensible {

// The matrix that springs and bending couple vertices in, blocks of 3 x 3, and where each spring
// and each bending stencil adds to it.
struct SpringHessian {
  SpringHessian(const Problem& problem, double stiffness);  // EA of the edges, N

  struct Spring {
    int a, b;                     // vertices
    int fa, fb;                   // their places among free vertices, -1 if pinned
    double rest, k;               // m, N/m
    std::array<int, 3> coupling;  // where each of its block's columns begins among the values
  };
  struct Hinge {                                 // a bending stencil's places
    std::array<int, 4> f;                        // among the free vertices, -1 if pinned
    std::array<std::array<int, 3>, 6> coupling;  // of the pairs 10, 20, 21, 30, 31, 32
  };
  struct Places {  // of a diagonal block's numbers among the matrix's values
    int xx, xy, yy, xz, yz, zz;
  };

  std::vector<Spring> springs;  // edges, then shear
  std::vector<Hinge> hinges;    // one a bending stencil
  VertexMatrix matrix;
  std::vector<Places> diagonal;  // one a free vertex
};

class ImplicitSprings final : public Stepper {
 public:
  ImplicitSprings(std::shared_ptr<const Problem> problem, const BackendOptions& options);
  const char* linear_solver() const override { return hessian_.matrix.linear_solver.c_str(); }
  double reciprocal_condition() const override {
    return hessian_.matrix.solver->reciprocal_condition();
  }

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
  StepResult end_velocities(const State& before, double h, const Positions& x,
                            Positions& v) override;

  using Spring = SpringHessian::Spring;
  using Hinge = SpringHessian::Hinge;
  using Places = SpringHessian::Places;
  void add_block(const Spring& s, const std::array<double, 3>& d, double along, double transverse);

  SpringHessian hessian_;
  int max_iterations_;
  double step_tolerance_;       // m
  double reuse_below_;          // m
  Positions inertial_, trial_;  // x + h v + h^2 g, and a line search's positions
  Positions ahead_;             // where history leads
  Positions before_;            // x^n, with drag only
  // With contact inside only: n . gradient of each contact, J s^2 / m / kg: what its plane bears.
  std::vector<double> reaction_;
  enum class Release : char { never, once };
  std::vector<Release> released_;  // of each contact, in this step
  Eigen::VectorXd gradient_, step_;
  std::vector<double> pull_, pull_before_;  // N/m, predicted tension over length; the last step's
  Positions v_before_;                      // v^{n-1}
  double time_before_ = std::numeric_limits<double>::infinity();  // s, of v_before_
};

}  // namespace inextensible
