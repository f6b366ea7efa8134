#include "solvers/problem/bending.h"

namespace inextensible {
// Curvature is the second difference 2 / (l_ab + l_bc) [(x_c - x_b) / l_bc - (x_b - x_a) / l_ab].
BendingStencil yarn_bending(int a, int b, int c, double l_ab, double l_bc, double rigidity) {
  const double share = 0.5 * (l_ab + l_bc);
  return {{a, b, c, a}, {1 / l_ab, -1 / l_ab - 1 / l_bc, 1 / l_bc, 0}, rigidity / share};
}

double bending_energy(const Bending& bending, const Eigen::Matrix3Xd& x) {
  double energy = 0;
  for (const BendingStencil& s : bending) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += s.coefficient[i] * x.col(s.vertex[i]);
    energy += 0.5 * s.stiffness * sum.squaredNorm();
  }
  return energy;
}

}  // namespace inextensible
