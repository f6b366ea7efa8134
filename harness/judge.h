// The harness judges, never the solver: strain, energy and symmetry recomputed from positions, off
// the clock.
#pragma once

#include "point.h"
#include "scene.h"

namespace harness {

class Judge {
 public:
  // sample_every: full statistics are taken at every so manieth step.
  Judge(const Scene& scene, int sample_every);

  // After each accepted step. filtered: positions before the collision filter. Returns the step's
  // largest |strain|, infinite if a position is not finite.
  double look(const inextensible::Positions& filtered, const inextensible::State& state);
  Verdict verdict() const;

 private:
  struct Range {
    double most = 0, stretch = 0;
  };
  Range strain_range(const inextensible::Positions& x) const;
  void sample(const inextensible::Positions& filtered, const inextensible::State& state);

  const Scene& scene_;
  int sample_every_;
  int steps_ = 0;
  Verdict running_;
  std::vector<double> strains_;  // |strain| of every edge at every sampled instant
  double start_energy_, energy_scale_;
  double kinetic_sum_ = 0;
  int samples_ = 0;
};

}  // namespace harness
