// What the harness reads off positions and velocities: the one place where strain, momentum,
// energy and shape are computed for the judge, the hard cases and `bench check`.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

// Above this strain a run has diverged: edges are no longer what they were by any count.
constexpr double diverged_strain = 10;

// Strain of an edge: |d| / l - 1. All infinite if a position is not finite.
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

}  // namespace harness
