#include <Eigen/SPQRSupport>
#include <random>

#include "harness/stability/cases.h"
#include "harness/stability/stability.h"

namespace harness {
namespace {

// Rank of the Jacobian of | d |^2 / l over all coordinates.
int rank_of_jacobian(const cases::Mesh& mesh) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto rows = static_cast<int>(mesh.parts.edges.size()),
             columns = static_cast<int>(3 * mesh.parts.mass.size());
  for (int k = 0; k < rows; ++k) {
    const auto e = static_cast<std::size_t>(k);
    const auto [a, b] = mesh.parts.edges[e];
    const Eigen::Vector3d u =
        2 * (mesh.start.x.col(b) - mesh.start.x.col(a)) / mesh.parts.rest_length[e];
    for (int axis = 0; axis < 3; ++axis) {
      entries.emplace_back(k, 3 * a + axis, -u[axis]);
      entries.emplace_back(k, 3 * b + axis, u[axis]);
    }
  }
  Eigen::SparseMatrix<double> jacobian(rows, columns);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return static_cast<int>(Eigen::SPQR<Eigen::SparseMatrix<double>>(jacobian).rank());
}

}  // namespace

std::vector<Freedom> degrees_of_freedom(int n) {
  std::vector<Freedom> list;
  for (auto [name, mesh] : {std::pair("quads", cases::cloth(n)),
                            {"triangles", cases::cloth(n, true)},
                            {"midpoints", cases::midpoint_cloth(n)}}) {
    std::mt19937_64 random(1);
    cases::add_noise(mesh.start.x, {}, 0.2 / (n - 1), random);
    const int rank = rank_of_jacobian(mesh);
    const auto edges = static_cast<int>(mesh.parts.edges.size()),
               coordinates = static_cast<int>(3 * mesh.parts.mass.size());
    list.push_back({name, n * n, edges, rank, coordinates - rank});
  }
  return list;
}

}  // namespace harness
