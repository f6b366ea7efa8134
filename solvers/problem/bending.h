// Bending as a quadratic energy,
//   V(x) = 1/2 sum over stencils s of k_s |sum_i c_i x_i|^2,
// whose gradient is a constant matrix times x. Where edges keep their length a yarn's curvature and
// a surface's mean curvature normal are linear in x, so this is not a linearization (Bergou et al.
// 2006, "A Quadratic Bending Model for Inextensible Surfaces").
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace inextensible {

struct BendingStencil {
  std::array<int, 4> vertex;          // the last is the first again in a stencil of three
  std::array<double, 4> coefficient;  // 1/m or 1, sum 0; 0 for an entry without a vertex
  double stiffness;                   // N m or N/m, so that the energy is in J
};
using Bending = std::vector<BendingStencil>;

// Stencil of a yarn through vertices a, b, c in links of lengths l_ab and l_bc (m), flexural
// rigidity EI (N m^2): energy EI / 2 times squared curvature times the length that falls to b.
BendingStencil yarn_bending(int a, int b, int c, double l_ab, double l_bc, double rigidity);

// J, at x (3 x n, m).
double bending_energy(const Bending& bending, const Eigen::Matrix3Xd& x);

}  // namespace inextensible
