// The shape of a cloth in four numbers, which can still be compared where paths are chaotic, and
// ensembles of them: runs of a scene by both routes of its reference from starts that are moved a
// little say how far runs that are all right are apart. A run's shape error is what it deviates
// beyond that.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "harness/points/measures.h"
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
// A number for each statistic.
void to_json(nlohmann::json& row, const ShapeStatistics& shape);
void from_json(const nlohmann::json& row, ShapeStatistics& shape);

bool is_cloth(const Scene& scene);  // it has shape statistics

// The statistics of positions, m.
ShapeStatistics shape_statistics(const Scene& scene, const inextensible::Positions& x);

// How often the hem rises and falls again by 2 % of the size or more on one way around the cloth. 0
// where its triangles have no single hem.
int count_folds(const Scene& scene, const inextensible::Positions& x);

// What a cloth at rest is judged by, x's minus y's: potential energy, corner height, shadow, folds.
std::map<std::string, double> rest_difference(const Scene& scene, const inextensible::Positions& x,
                                              const inextensible::Positions& y);

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
  double kinetic_at(double time) const;

  const Scene& scene_;
  std::vector<double> times_;
  inextensible::Velocities velocities_;
  ShapeSeries series_;
  std::size_t settled_ = 0;  // samples whose kinetic energy is known
  std::size_t steps_ = 0;
  Instant before_, last_;
};

constexpr double sure_deviations = 3;  // standard deviations that are no error
// Mean kinetic energy over the ensemble's: a run below hangs, one above shakes. What first-order
// methods dissipate at steps of 1/50 s leaves 0.68 to 0.74 on the drape.
constexpr double least_kinetic_ratio = 0.6, largest_kinetic_ratio = 1.25;

struct Ensemble {
  std::vector<std::string> methods;  // of the runs: solver, limit, step, how many of them
  double moved = 0;                  // a start's coordinates, at most, over an edge's length
  int runs = 0;                      // that came to the end
  ShapeSeries mean, deviation;       // at the reference's times; standard deviation of one run
  // The same of a run's kinetic energy averaged over the times up to each.
  std::vector<double> kinetic_deviation;
  std::string unknown_because;  // why there is none; "" if there is one, or it was never tried

  bool known() const { return !mean.empty(); }
};

// Mean and standard deviation (with n - 1) of runs that have come to the end, two at least.
Ensemble ensemble_of(const std::vector<ShapeSeries>& runs);

// The shape error of a run over its first samples, and its kinetic energy over the ensemble's;
// times: the reference's. Leaves them unknown without a sample and where a number is not finite.
void measure_shape(const Ensemble& ensemble, const std::vector<double>& times,
                   const ShapeSeries& run, Measures& measures);

// Whether that ratio is a run's that hangs or shakes.
bool kinetic_energy_lost(double ratio, double spread);

}  // namespace harness
