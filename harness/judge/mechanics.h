// What the harness reads off positions and velocities: the one place where strain, momentum,
// energy and shape are computed for the judge, the hard cases and `bench check`.
#pragma once

#include "harness/points/point.h"

namespace harness {

// Above this strain a run has diverged: edges are no longer what they were by any count.
constexpr double diverged_strain = 10;

// Strain of an edge: |d| / l - 1, over the edge's limit_scale if the problem has one. All infinite
// if a position is not finite.
struct StrainRange {
  double most = 0;       // largest |strain|
  double stretch = 0;    // largest strain, at least 0
  std::size_t edge = 0;  // of the largest |strain|, the first of several
};
// x: 3 x vertices, m.
StrainRange strain_range(const Problem& problem, const Positions& x);

// Appends every edge's |strain|.
void append_strains(const Problem& problem, const Positions& x, std::vector<double>& strains);

// kg m/s, of the velocities v (3 x vertices, m/s).
Eigen::Vector3d linear_momentum(const Problem& problem, const Positions& v);
// kg m^2/s, about the centre of mass.
Eigen::Vector3d angular_momentum(const Problem& problem, const State& state);

// J, kinetic and potential.
double total_energy(const Problem& problem, const State& state);
// J, weight times size, and the kinetic energy at the start: what energies are compared with.
double energy_scale(const Scene& scene);

// The larger of both; a figure that is not yet known (NaN) becomes the value.
void raise(double& figure, double value);

// m^2, of the shadow on a horizontal plane within `reach` (m) of the y axis, on pixels x pixels.
double shadow_area(const Scene& scene, const Positions& x, double reach, int pixels);

// Something dissipates, and nothing that moves does work.
bool energy_can_only_fall(const Problem& problem);

// The energy of a run, followed at every step: the one place that says whether energy was made out
// of nothing, for sweeps and for hard cases.
//
// Positions belong to the ends of steps. So do the velocities of some methods; those of the others,
// (x_n - x_{n-1}) / h, belong to the middle of the step, and the kinetic energy at its end is then
// interpolated between the middles before and after it. Without interpolation it would lag by
// h / 2 and show gains, of first order in h, wherever a motion slows down. It is the energies that
// are interpolated and not the velocities: the mean velocity of a vibration that turns round in
// every step is zero.
class EnergyRecord {
 public:
  // From the scene's start. Its problem must outlive this.
  EnergyRecord(const Scene& scene, Velocities velocities);

  // What energy is compared with from here on. scale: J, what gains are divided by.
  void begin(const State& state, double scale);
  // After each accepted step of h seconds, and after the last one. Gives (E - E_0) / scale at the
  // end of the step, or of the one before it, if it has just become known.
  std::optional<double> after(const State& state, double h);
  std::optional<double> finish();

  double gain() const { return gain_; }  // the largest so far; unknown at first
  double gain_time() const { return gain_time_; }
  int gain_step() const { return gain_step_; }
  double drift() const { return drift_; }  // the largest |E - E_0| / scale
  // All rises of energy together, over scale, from the mean of one window of 0.01 s to that of the
  // next, or from step to step where steps are longer: what was dissipated and is then pumped back
  // shows here, and not in gain(). Means, since the velocities of two-step methods overshoot for a
  // step wherever an edge meets its limit.
  double rise() const { return rise_; }
  double scale() const { return scale_; }
  const Problem& problem() const { return problem_; }

 private:
  struct Instant {
    int step = 0;
    double time = 0, h = 0, potential = 0, kinetic = 0;  // kinetic: in the middle of the step
  };
  double settle(const Instant& at, double kinetic);

  const Problem& problem_;
  double scale_;
  Velocities velocities_;
  double start_ = 0;
  Instant before_, last_;
  double gain_ = unknown, gain_time_ = unknown, drift_ = unknown;
  double rise_ = 0;
  struct Window {
    double sum = 0, length = 0, before = 0;  // of gains by time, s, mean of the last one
  } window_;
  int gain_step_ = 0;
};

// Why a run of `seconds` fails the energy check; "": it passes. bound: of Scene.
std::string energy_gained(const EnergyRecord& energy, double bound, double seconds);

}  // namespace harness
