#include "harness/stability/freedom.h"

#include <SuiteSparseQR.hpp>
#include <random>

#include "harness/stability/cases.h"

namespace harness {
namespace {

// Rank of the Jacobian of | d |^2 / l over all coordinates.
int rank_of_jacobian(const cases::Mesh& mesh, cholmod_common& common) {
  const auto rows = mesh.parts.edges.size(), columns = 3 * mesh.parts.mass.size();
  cholmod_triplet* triplet =
      cholmod_l_allocate_triplet(rows, columns, 6 * rows, 0, CHOLMOD_REAL, &common);
  auto* row = static_cast<SuiteSparse_long*>(triplet->i);
  auto* column = static_cast<SuiteSparse_long*>(triplet->j);
  auto* value = static_cast<double*>(triplet->x);
  for (std::size_t k = 0; k < rows; ++k) {
    const auto [a, b] = mesh.parts.edges[k];
    const Eigen::Vector3d u =
        2 * (mesh.start.x.col(b) - mesh.start.x.col(a)) / mesh.parts.rest_length[k];
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool at_b : {false, true}) {
        row[triplet->nnz] = static_cast<SuiteSparse_long>(k);
        column[triplet->nnz] = 3 * (at_b ? b : a) + axis;
        value[triplet->nnz++] = at_b ? u[axis] : -u[axis];
      }
    }
  }
  cholmod_sparse* j = cholmod_l_triplet_to_sparse(triplet, triplet->nnz, &common);
  SuiteSparseQR_factorization<double>* qr =
      SuiteSparseQR_factorize<double>(SPQR_ORDERING_DEFAULT, SPQR_DEFAULT_TOL, j, &common);
  const auto rank = static_cast<int>(qr->rank);
  SuiteSparseQR_free(&qr, &common);
  cholmod_l_free_sparse(&j, &common);
  cholmod_l_free_triplet(&triplet, &common);
  return rank;
}

}  // namespace

std::vector<Freedom> degrees_of_freedom(int n) {
  std::vector<Freedom> list;
  cholmod_common common{};
  cholmod_l_start(&common);
  for (auto [name, mesh] : {std::pair("quads", cases::cloth(n)),
                            {"triangles", cases::cloth(n, true)},
                            {"midpoints", cases::midpoint_cloth(n)}}) {
    std::mt19937_64 random(1);
    cases::add_noise(mesh.start.x, {}, 0.2 / (n - 1), random);
    const int rank = rank_of_jacobian(mesh, common);
    const auto edges = static_cast<int>(mesh.parts.edges.size()),
               coordinates = static_cast<int>(3 * mesh.parts.mass.size());
    list.push_back({name, n * n, edges, rank, coordinates - rank});
  }
  cholmod_l_finish(&common);
  return list;
}

}  // namespace harness
