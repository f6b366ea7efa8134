#include "solvers/problem/triangle_collider.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace inextensible {
namespace {

using Eigen::Vector3d;

// The largest pieces have a surface each, and the others one together.
constexpr std::size_t most_pieces = 8;

// The pieces of a mesh; the whole where one of them is a hollow, inside out, in another.
std::vector<TriangleMesh> surfaces_of(const TriangleMesh& mesh) {
  const std::vector<int> piece_of = pieces_of(mesh.vertices.size(), mesh.triangles);
  struct Piece {
    Eigen::AlignedBox3d box;
    double volume = 0;  // six times
    std::size_t mesh = 0;
  };
  std::map<int, Piece> found;  // those with triangles
  const Vector3d origin = mesh.vertices.empty() ? Vector3d::Zero() : mesh.vertices[0];
  for (const auto& triangle : mesh.triangles) {
    Piece& piece = found[piece_of[triangle[0]]];
    std::array<Vector3d, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      piece.box.extend(mesh.vertices[triangle[k]]);
      corner[k] = mesh.vertices[triangle[k]] - origin;
    }
    piece.volume += corner[0].dot(corner[1].cross(corner[2]));
  }
  if (found.size() < 2 ||
      std::ranges::any_of(found, [](const auto& one) { return !(one.second.volume > 0); }))
    return {mesh};
  std::vector<Piece*> by_size;
  by_size.reserve(found.size());
  for (auto& [unused, piece] : found) by_size.push_back(&piece);
  std::ranges::stable_sort(by_size, std::greater<>(),
                           [](const Piece* piece) { return piece->box.diagonal().norm(); });
  std::vector<TriangleMesh> meshes(std::min(by_size.size(), most_pieces));
  for (std::size_t i = 0; i < by_size.size(); ++i) by_size[i]->mesh = std::min(i, most_pieces - 1);
  std::vector<int> place(piece_of.size(), -1);
  for (auto triangle : mesh.triangles) {
    TriangleMesh& to = meshes[found.at(piece_of[triangle[0]]).mesh];
    for (int& v : triangle) {
      if (place[v] < 0) {
        place[v] = static_cast<int>(to.vertices.size());
        to.vertices.push_back(mesh.vertices[v]);
      }
      v = place[v];
    }
    to.triangles.push_back(triangle);
  }
  return meshes;
}

template <class Ask>
ClosedSurface::Nearest least_of(const std::vector<ClosedSurface>& pieces, const Ask& ask) {
  ClosedSurface::Nearest least = ask(pieces[0]);
  for (std::size_t i = 1; i < pieces.size(); ++i)
    if (const auto here = ask(pieces[i]); here.signed_distance < least.signed_distance)
      least = here;
  return least;
}

}  // namespace

TriangleMesh icosphere(const Vector3d& centre, double radius, int subdivisions) {
  const double t = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (Vector3d& v : mesh.vertices) v.normalize();
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto midpoint = [&](int i, int j) {
      const auto [place, fresh] =
          middle.try_emplace(std::minmax(i, j), static_cast<int>(mesh.vertices.size()));
      if (fresh) {
        const Vector3d sum = mesh.vertices[i] + mesh.vertices[j];
        mesh.vertices.push_back(sum.normalized());
      }
      return place->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [i, j, k] : mesh.triangles) {
      const int ij = midpoint(i, j), jk = midpoint(j, k), ki = midpoint(k, i);
      finer.insert(finer.end(), {{i, ij, ki}, {j, jk, ij}, {k, ki, jk}, {ij, jk, ki}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vector3d& v : mesh.vertices) v = centre + radius * v;
  return mesh;
}

void add_block(TriangleMesh& mesh, const Vector3d& low, const Vector3d& high) {
  const auto first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 4 ? high : low).x(), (i & 2 ? high : low).y(),
                               (i & 1 ? high : low).z());
  for (const auto& [a, b, c, d] : std::initializer_list<std::array<int, 4>>{
           {0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.triangles.push_back({first + a, first + c, first + d});
  }
}

TriangleCollider::TriangleCollider(TriangleMesh mesh, double friction)
    : mesh_(std::move(mesh)), friction_(friction) {
  std::vector<ClosedSurface> pieces;
  for (TriangleMesh& piece : surfaces_of(mesh_)) pieces.emplace_back(std::move(piece));
  pieces_ = std::make_shared<const std::vector<ClosedSurface>>(std::move(pieces));
}

Collider::Memory TriangleCollider::nothing_of(int vertices) const {
  return Collider::nothing_of(vertices * static_cast<int>(pieces_->size()));
}

void TriangleCollider::find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass,
                            double depth, Memory& memory, std::vector<ContactPlane>& planes,
                            WorkCounters& work) const {
  planes.clear();
  Eigen::Index first_row = 0;
  for (const ClosedSurface& piece : *pieces_) {
    piece.find(x, inverse_mass, depth, first_row, memory, planes, work);
    first_row += x.cols();
  }
  if (pieces_->size() == 1) return;
  std::ranges::sort(planes, {}, [&](const ContactPlane& plane) {
    return std::pair(plane.vertex, plane.normal.dot(x.col(plane.vertex)) - plane.offset);
  });
  const auto same = [](const ContactPlane& a, const ContactPlane& b) {
    return a.vertex == b.vertex;
  };
  planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
}

bool TriangleCollider::plane_at(const Vector3d& p, ContactPlane& plane, WorkCounters& work) const {
  if (pieces_->size() == 1) return pieces_->front().plane_at(p, plane, work);
  double least = std::numeric_limits<double>::infinity();
  ContactPlane here = plane;
  for (const ClosedSurface& piece : *pieces_) {
    if (!piece.plane_at(p, here, work)) continue;
    if (const double height = here.normal.dot(p) - here.offset; height < least) {
      least = height;
      plane = here;
    }
  }
  return least < std::numeric_limits<double>::infinity();
}

TriangleCollider::Nearest TriangleCollider::nearest(const Vector3d& p) const {
  return least_of(*pieces_, [&](const ClosedSurface& piece) { return piece.nearest(p); });
}

TriangleCollider::Nearest TriangleCollider::nearest_by_all(const Vector3d& p) const {
  return least_of(*pieces_, [&](const ClosedSurface& piece) { return piece.nearest_by_all(p); });
}

}  // namespace inextensible
