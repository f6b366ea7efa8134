// The harness judges: strain, energy and errors, from positions and off the clock.
#pragma once

#include "harness/judge/mechanics.h"
#include "harness/judge/reference.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {

// Vertices that passed through the body within a step: in through a face, and out through one that
// looks the other way. Such a vertex was never seen inside, so no contact held it. A way that cuts
// a bulge or a corner of the body leaves through a face that looks a similar way, and is none.
class Crossings {
 public:
  // Without a body made of triangles it sees nothing, and costs nothing.
  explicit Crossings(const Problem& problem);

  // Before and after each step.
  void before(const State& state);
  void after(const State& state);

  int vertices() const;  // that have passed through so far

 private:
  Positions in_body_frame(const State& state) const;
  bool passes_through(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  const Problem& problem_;
  const inextensible::TriangleMesh* body_ = nullptr;
  double thickness_ = 0;  // m, about the least of the body
  Positions from_;
  std::vector<char> crossed_;
};

// The residual of a projection method (Goldenthal et al. 2007, section 4.2 and Figure 3), off the
// clock: after iteration j, F_j = (x_j - x_0) + h^2 W J(x_j)^T lambda_j with lambda_j the sum of
// the dlambda so far, says how far the iterate is from the solution of implicit constraint
// directions. Iterates and multipliers are those of the solver that runs.
class ResidualProbe final : public inextensible::IterateObserver {
 public:
  // Looks at the next step, until it is asked for its residual; else iterates pass unseen.
  void watch() {
    watching_ = true;
    iterations_ = 0;
  }
  // The mean of |F| over vertices in the step since watch(), accepted at this time (s). Nothing if
  // the step needed no iteration.
  std::optional<ResidualSample> residual(double time);

  void iterate(const inextensible::EdgeConstraints& edges, int j, const Positions& x,
               const Eigen::VectorXd& multipliers) override;

 private:
  struct Iterate {
    Positions x;
    Eigen::VectorXd multipliers;
  };
  double mean_residual(const Iterate& at) const;

  bool watching_ = false;
  const inextensible::EdgeConstraints* edges_ = nullptr;  // the solver's
  int iterations_ = 0;
  Positions x0_;
  Iterate first_, last_;
};

class Judge {
 public:
  struct Options {
    int sample_every = 1;  // full statistics are taken at every n-th step
    std::shared_ptr<const Reference> reference = nullptr;
    Velocities velocities = Velocities::half_step;  // the method's
    bool residuals = false;  // are recorded where the solver shows its iterates (observer())
  };
  Judge(const Scene& scene, const Options& options);

  // Observes the stepper; null: nothing does. Valid as long as the judge.
  inextensible::IterateObserver* observer() { return probe_ ? &*probe_ : nullptr; }

  // Before and after each accepted step of h seconds. filtered: positions before the collision
  // filter. `after` returns the step's largest |strain|, infinite if a position is not finite.
  void before(const State& state, double h);
  // counts: whether the step counts towards sample_every (a step controller's parts do not).
  double after(const Positions& filtered, const State& state, double h, bool counts = true);
  // After the last step.
  Measures finish();
  const EnergyRecord& energy() const { return energy_; }
  const Crossings& crossings() const { return crossings_; }

 private:
  void sample(const Positions& filtered, const State& state);
  void look_at_marks(const State& state, double h);
  void compare(const State& state);
  void add_errors(Measures& measures) const;

  const Scene& scene_;
  Options options_;
  int steps_ = 0;
  Measures running_;
  std::vector<double> strains_;  // |strain| of every edge at every sampled instant
  EnergyRecord energy_;
  Crossings crossings_;
  double kinetic_sum_ = 0;
  double marked_time_ = 0, squared_speed_ = 0;  // s, m^2/s^2 times s: over the last third
  int samples_ = 0;

  std::optional<ResidualProbe> probe_;
  State start_;           // of the step, where a sample lies inside it
  std::size_t next_ = 0;  // of the reference's samples
  double moved_squares_ = 0, reference_moved_squares_ = 0;  // distances from the start
};

}  // namespace harness
