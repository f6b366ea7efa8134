// The energy of a run, followed at every step: the one place that says whether energy was made out
// of nothing, for sweeps and for hard cases.
//
// Positions belong to the ends of steps. So do the velocities of some methods; those of the others,
// (x_n - x_{n-1}) / h, belong to the middle of the step, and the kinetic energy at its end is then
// interpolated between the middles before and after it. Taken as it stands, it would lag behind by
// h / 2 and show gains, of first order in h, wherever a motion slows down. It is the energies that
// are interpolated and not the velocities: the mean velocity of a vibration that turns round in
// every step is zero.
#pragma once

#include "harness/points/point.h"

namespace harness {

// Something dissipates, and nothing that moves does work.
bool energy_can_only_fall(const Problem& problem);

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
