#include "harness/judge/energy.h"

#include "harness/base/text.h"
#include "harness/judge/mechanics.h"
#include "solvers/problem/forces.h"

namespace harness {

bool energy_can_only_fall(const Problem& problem) {
  return (problem.collider() || problem.has_drag()) && !problem.body_motion();
}

EnergyRecord::EnergyRecord(const Scene& scene, Velocities velocities)
    : problem_(*scene.problem), velocities_(velocities) {
  begin(scene.start, energy_scale(scene));
}

void EnergyRecord::begin(const State& state, double scale) {
  scale_ = scale;
  start_ = total_energy(problem_, state);
  before_ = last_ = {};
  window_ = {};
}

std::optional<double> EnergyRecord::after(const State& state, double h) {
  before_ = last_;
  last_ = {before_.step + 1, state.time, h, inextensible::potential_energy(problem_, state.x),
           inextensible::kinetic_energy(problem_, state.v)};
  if (velocities_ == Velocities::whole_step) return settle(last_, last_.kinetic);
  if (before_.step == 0) return {};
  return settle(before_, (h * before_.kinetic + before_.h * last_.kinetic) / (h + before_.h));
}

// No velocity follows the last step: its own, or what the last two foretell if that is less.
std::optional<double> EnergyRecord::finish() {
  if (velocities_ == Velocities::whole_step || last_.step == 0) return {};
  double kinetic = last_.kinetic;
  if (before_.step > 0)
    kinetic += std::min(0.0, (last_.kinetic - before_.kinetic) * last_.h / (last_.h + before_.h));
  return settle(last_, kinetic);
}

double EnergyRecord::settle(const Instant& at, double kinetic) {
  const double gain = (at.potential + kinetic - start_) / scale_;
  if (!(gain <= gain_)) {  // unknown at first
    gain_ = gain;
    gain_time_ = at.time;
    gain_step_ = at.step;
  }
  raise(drift_, std::abs(gain));
  constexpr double window_length = 0.01;  // s
  window_.sum += gain * at.h;
  window_.length += at.h;
  if (window_.length >= window_length * (1 - 1e-9)) {
    const double mean = window_.sum / window_.length;
    rise_ += std::max(0.0, mean - window_.before);
    window_ = {0, 0, mean};
  }
  return gain;
}

std::string energy_gained(const EnergyRecord& energy, double bound, double seconds) {
  if (energy.gain() > bound)
    return concat("energy ", number_text(energy.gain(), 3), " of weight times size above the ",
                  "start's at step ", energy.gain_step(), " (t = ", energy.gain_time(),
                  " s), permitted are ", bound);
  const double in_all = bound * std::max(1.0, seconds);
  if (energy_can_only_fall(energy.problem()) && energy.rise() > in_all)
    return concat("energy rose by ", number_text(energy.rise(), 3), " of weight times size in all,",
                  " where it can only fall; permitted are ", in_all);
  return "";
}

}  // namespace harness
