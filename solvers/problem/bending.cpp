#include "solvers/problem/bending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace inextensible {
namespace {

using Eigen::Vector3d;

// Cotangent of the angle between two vectors.
double cotangent(const Vector3d& a, const Vector3d& b) { return a.dot(b) / a.cross(b).norm(); }

}  // namespace

// Curvature is the second difference 2 / (l_ab + l_bc) [(x_c - x_b) / l_bc - (x_b - x_a) / l_ab].
BendingStencil yarn_bending(int a, int b, int c, double l_ab, double l_bc, double rigidity) {
  const double share = 0.5 * (l_ab + l_bc);
  return {{a, b, c, a}, {1 / l_ab, -1 / l_ab - 1 / l_bc, 1 / l_bc, 0}, rigidity / share};
}

// With the edge from x_0 to x_1 and x_2, x_3 across it, K = (c_03 + c_04, c_01 + c_02, -c_01 -
// c_03, -c_02 - c_04), c the cotangents of the angles at its ends, and V = 1/2 B / (A_0 + A_1) |K
// x|^2. The authors have 3 B there: a cylinder of equilateral triangles then bends with thrice B,
// whichever way it is rolled.
Bending plate_bending(const std::vector<std::array<int, 3>>& triangles, const Eigen::Matrix3Xd& x,
                      double rigidity) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> sides;  // triangles at each edge
  std::vector<double> area(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    area[t] = 0.5 * Vector3d(x.col(b) - x.col(a)).cross(Vector3d(x.col(c) - x.col(a))).norm();
    if (!(area[t] > 0))
      throw std::invalid_argument("triangle " + std::to_string(t) + " has no area");
    for (const auto& [p, q] : {std::pair(a, b), {b, c}, {c, a}})
      sides[std::minmax(p, q)].push_back(t);
  }
  Bending all;
  for (const auto& [edge, at] : sides) {
    if (at.size() != 2) continue;
    const auto [e0, e1] = edge;
    const auto opposite = [&triangles, &edge = edge](std::size_t t) {
      return *std::ranges::find_if(triangles[t],
                                   [&edge](int v) { return v != edge.first && v != edge.second; });
    };
    const int e2 = opposite(at[0]), e3 = opposite(at[1]);
    const auto from = [&x](int p, int q) -> Vector3d { return x.col(q) - x.col(p); };
    const double c01 = cotangent(from(e0, e1), from(e0, e2)),
                 c02 = cotangent(from(e0, e1), from(e0, e3)),
                 c03 = cotangent(from(e1, e0), from(e1, e2)),
                 c04 = cotangent(from(e1, e0), from(e1, e3));
    all.push_back({{e0, e1, e2, e3},
                   {c03 + c04, c01 + c02, -c01 - c03, -c02 - c04},
                   rigidity / (area[at[0]] + area[at[1]])});
  }
  return all;
}

double bending_energy(const Bending& bending, const Eigen::Matrix3Xd& x) {
  double energy = 0;
  for (const BendingStencil& s : bending) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += s.coefficient[i] * x.col(s.vertex[i]);
    energy += 0.5 * s.stiffness * sum.squaredNorm();
  }
  return energy;
}

}  // namespace inextensible
