// The shape of a cloth in four numbers: what can still be compared where paths are chaotic.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "harness/scenes/scene.h"
#include "solvers/methods/backend.h"

namespace harness {

struct ShapeStatistics {
  double potential_energy = 0;  // over weight times size
  double kinetic_energy = 0;    // the same; of positions alone 0
  double corner_height = 0;     // mean over the cloth's corners, over size
  double shadow = 0;            // area of the shadow on a horizontal plane, over size^2
};
using ShapeSeries = std::vector<ShapeStatistics>;  // at sample times

struct ShapeStatisticInfo {
  const char* name;
  double ShapeStatistics::*member;
};
// In the order in which files have them.
inline constexpr std::array shape_statistic_infos{
    ShapeStatisticInfo{"potential_energy", &ShapeStatistics::potential_energy},
    ShapeStatisticInfo{"kinetic_energy", &ShapeStatistics::kinetic_energy},
    ShapeStatisticInfo{"corner_height", &ShapeStatistics::corner_height},
    ShapeStatisticInfo{"shadow", &ShapeStatistics::shadow}};

bool is_cloth(const Scene& scene);  // it has shape statistics

// The statistics of positions, m.
ShapeStatistics shape_statistics(const Scene& scene, const inextensible::Positions& x);

// The statistics of a run at sample times. Velocities that belong to the middle of a step are
// treated as EnergyRecord does: kinetic energies are interpolated between middles.
class ShapeRecord {
 public:
  // times: s, ascending. The scene must outlive this.
  ShapeRecord(const Scene& scene, std::vector<double> times, inextensible::Velocities velocities);

  // The positions at the next sample time.
  void sample(const inextensible::Positions& x);
  // After each accepted step of h seconds, and after the samples that it has reached.
  void step(const inextensible::State& state, double h);
  // After the last step: the statistics at the sample times that the run has reached.
  const ShapeSeries& finish();

 private:
  struct Instant {
    double time = 0, kinetic = 0;  // s, over weight times size
  };
  double kinetic_at(double time, const Instant& from, const Instant& to) const;

  const Scene& scene_;
  std::vector<double> times_;
  inextensible::Velocities velocities_;
  ShapeSeries series_;
  std::size_t settled_ = 0;  // samples whose kinetic energy is known
  std::size_t steps_ = 0;
  Instant before_, last_;
};

}  // namespace harness
