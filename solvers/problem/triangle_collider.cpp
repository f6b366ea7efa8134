#include "solvers/problem/triangle_collider.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace inextensible {
namespace {

using Eigen::Vector3d;

// Cells farther inside than this many cell diagonals ask all triangles.
constexpr double deep_cells = 1;

// Blocks of cells with this many planes at most are not divided.
constexpr std::size_t short_list = 8;

// Whether vertex v is no deeper than `depth` behind the plane that is remembered of it.
inline bool in_front(const Collider::Memory& memory, const Eigen::Matrix3Xd& x, Eigen::Index v,
                     double depth) {
  const double *plane = memory.data() + v, *p = x.data() + 3 * v;
  const Eigen::Index n = memory.rows();
  return plane[0] * p[0] + plane[n] * p[1] + plane[2 * n] * p[2] - plane[3 * n] >= -depth;
}

constexpr Eigen::Index asked_at_once = 8;

// The same of all vertices from first to first + asked_at_once, without a branch.
inline bool outside_known(const Collider::Memory& memory, const Eigen::Matrix3Xd& x,
                          Eigen::Index first, double depth) {
  std::int64_t behind = 0;
  for (Eigen::Index i = 0; i < asked_at_once; ++i)
    behind += in_front(memory, x, first + i, depth) ? 0 : 1;
  return behind == 0;
}

const Vector3d& corner(const TriangleMesh& mesh, int triangle, int i) {
  return mesh.vertices[mesh.triangles[triangle][i]];
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

TriangleCollider::TriangleCollider(TriangleMesh mesh, double friction)
    : mesh_(std::move(mesh)), friction_(friction) {
  find_pseudonormals();
  check_orientation();
  lay_out_grid();
}

// A face's own normal; the sum of both faces' at an edge; the angle-weighted sum at a corner.
// convex_: whether no edge is reentrant.
void TriangleCollider::find_pseudonormals() {
  struct AtEdge {
    Vector3d sum = Vector3d::Zero();
    int faces = 0, first_face = 0;
  };
  std::vector<Vector3d> at_vertex(mesh_.vertices.size(), Vector3d::Zero());
  std::map<std::pair<int, int>, AtEdge> at_edge;
  convex_ = true;
  pseudonormal_.resize(mesh_.triangles.size());
  for (int f = 0; f < triangles(); ++f) {
    const auto& triangle = mesh_.triangles[f];
    std::array<Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = corner(mesh_, f, i);
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    pseudonormal_[f][0] = normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d next = (p[(i + 1) % 3] - p[i]).normalized(),
                     last = (p[(i + 2) % 3] - p[i]).normalized();
      at_vertex[triangle[i]] += std::acos(std::clamp(next.dot(last), -1.0, 1.0)) * normal;
      AtEdge& edge = at_edge[std::minmax(triangle[i], triangle[(i + 1) % 3])];
      edge.sum += normal;
      if (edge.faces++ == 0) edge.first_face = f;
      const Vector3d opposite = p[(i + 2) % 3] - p[i];
      convex_ = convex_ && opposite.dot(pseudonormal_[edge.first_face][0]) <= 1e-9 * p[i].norm();
    }
  }
  for (const auto& [ends, edge] : at_edge) {
    if (edge.faces != 2) {
      throw std::invalid_argument("collider: edge (" + std::to_string(ends.first) + ", " +
                                  std::to_string(ends.second) + ") has " +
                                  std::to_string(edge.faces) + " triangles, a closed mesh has 2");
    }
  }
  for (int f = 0; f < triangles(); ++f) {
    const auto& triangle = mesh_.triangles[f];
    for (std::size_t i = 0; i < 3; ++i) {
      pseudonormal_[f][1 + i] =
          at_edge.at(std::minmax(triangle[i], triangle[(i + 1) % 3])).sum.normalized();
      pseudonormal_[f][4 + i] = at_vertex[triangle[i]].normalized();
    }
  }
}

// A surface without reentrant edges that covers all directions from a point behind its faces, and
// each of them once, is convex (Tietze 1928, Nakajima 1928).
void TriangleCollider::check_orientation() {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& v : mesh_.vertices) middle += v / static_cast<double>(mesh_.vertices.size());
  double volume = 0, covered = 0;  // solid angle
  for (int f = 0; f < triangles(); ++f) {
    const Vector3d a = corner(mesh_, f, 0) - middle, b = corner(mesh_, f, 1) - middle,
                   c = corner(mesh_, f, 2) - middle;
    const double product = a.dot(b.cross(c));
    volume += product;
    convex_ = convex_ && product > 0;
    covered += 2 * std::atan2(product, a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                           b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  convex_ = convex_ && covered < 6 * std::numbers::pi;
  if (!(volume > 0)) {
    throw std::invalid_argument(
        "collider: the mesh is inside out; its triangles must be "
        "counter-clockwise seen from outside");
  }
}

void TriangleCollider::lay_out_grid() {
  Vector3d high = low_ = mesh_.vertices.front();
  for (const Vector3d& v : mesh_.vertices) {
    low_ = low_.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Vector3d box_margin =
      Vector3d::Constant(1e-9 * (high - low_).norm());  // no vertex on the grid's own border
  low_ -= box_margin;
  cell_size_ = (high + box_margin - low_) / resolution;
  inverse_cell_size_ = cell_size_.cwiseInverse();
  for (int f = 0; f < triangles(); ++f) {
    const Vector3d& normal = pseudonormal_[f][0];
    planes_.emplace_back(normal.x(), normal.y(), normal.z(), normal.dot(corner(mesh_, f, 0)));
  }
  std::vector<int> all(triangles());
  std::iota(all.begin(), all.end(), 0);
  cell_.assign(resolution * resolution * resolution, outside);
  lists_.push_back(all);  // deep
  convex_ ? refine_planes(Eigen::Vector3i::Zero(), resolution, all)
          : refine(Eigen::Vector3i::Zero(), resolution, all);
}

std::size_t TriangleCollider::cell_index(const Eigen::Vector3i& cell) const {
  return (cell[2] * resolution + cell[1]) * resolution + cell[0];
}

void TriangleCollider::fill(const Eigen::Vector3i& cell, int size, int list) {
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) cell_[cell_index(cell + Eigen::Vector3i(i, j, k))] = list;
    }
  }
}

// candidates: every plane that some point of the block of size^3 cells that begins at `cell` is
// least behind. Those that it is behind farther than one of these all over the block go: tried are
// planes of its corners and its centre. A block in front of one plane needs no other.
void TriangleCollider::refine_planes(const Eigen::Vector3i& cell, int size,
                                     const std::vector<int>& candidates) {
  const Vector3d half = 0.5 * size * cell_size_;
  const Vector3d centre = low_ + cell_size_.cwiseProduct(cell.cast<double>()) + half;
  double distance = 0, unused = 0;
  std::vector<int> found{least_behind(candidates, centre, distance)}, kept;
  const auto spread = [&](const Eigen::RowVector4d& plane) {
    return plane.head<3>().cwiseAbs().dot(half);
  };
  if (distance > spread(planes_[found[0]])) {
    kept = found;
  } else {
    for (int octant = 0; octant < 8; ++octant) {
      const Vector3d sign(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
      const int nearest = least_behind(candidates, centre + half.cwiseProduct(sign), unused);
      if (std::ranges::find(found, nearest) == found.end()) found.push_back(nearest);
    }
    std::ranges::copy_if(candidates, std::back_inserter(kept), [&](int candidate) {
      return std::ranges::none_of(found, [&](int other) {
        const Eigen::RowVector4d lead = planes_[other] - planes_[candidate];
        return other != candidate && lead.head<3>().dot(centre) - lead[3] > spread(lead);
      });
    });
  }
  const bool deep_inside = distance < -half.norm() - deep_cells * cell_size_.norm();
  if (size == 1 || kept.size() <= short_list || deep_inside) {
    fill(cell, size, static_cast<int>(lists_.size()));
    lists_.push_back(kept);
    return;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3i offset(octant & 1, (octant >> 1) & 1, octant >> 2);
    refine_planes(cell + size / 2 * offset, size / 2, kept);
  }
}

// candidates: every triangle that is nearest to some point of the block of size^3 cells that begins
// at `cell`.
void TriangleCollider::refine(const Eigen::Vector3i& cell, int size,
                              const std::vector<int>& candidates) {
  const Vector3d centre =
      low_ + cell_size_.cwiseProduct(cell.cast<double>() + Vector3d::Constant(0.5 * size));
  const double half_diagonal = 0.5 * size * cell_size_.norm();
  std::vector<double> distance(candidates.size());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    distance[i] = std::sqrt(closest(candidates[i], centre).squared);
    least = std::min(least, distance[i]);
  }
  if (least > half_diagonal) {  // the surface does not pass through
    const bool inside = nearest_among(candidates, centre).signed_distance < 0;
    if (!inside) return;
    if (least > half_diagonal + deep_cells * cell_size_.norm()) return fill(cell, size, deep);
  }
  std::vector<int> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (distance[i] <= (least + 2 * half_diagonal) * (1 + 1e-12)) kept.push_back(candidates[i]);
  }
  if (size == 1) {
    cell_[cell_index(cell)] = static_cast<int>(lists_.size());
    lists_.push_back(kept);
    return;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3i offset(octant & 1, (octant >> 1) & 1, octant >> 2);
    refine(cell + size / 2 * offset, size / 2, kept);
  }
}

// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
TriangleCollider::Closest TriangleCollider::closest(int triangle, const Vector3d& p) const {
  const Vector3d &a = corner(mesh_, triangle, 0), &b = corner(mesh_, triangle, 1),
                 &c = corner(mesh_, triangle, 2);
  const auto at = [&p](const Vector3d& q, int feature) {
    return Closest{q, (p - q).squaredNorm(), feature};
  };
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return at(a, 4);
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return at(b, 5);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(a + d1 / (d1 - d3) * ab, 1);
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return at(c, 6);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(a + d2 / (d2 - d6) * ac, 3);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return at(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 2);
  const double sum = va + vb + vc;
  return at(a + vb / sum * ab + vc / sum * ac, 0);
}

TriangleCollider::Nearest TriangleCollider::nearest_among(std::span<const int> triangles,
                                                          const Vector3d& p) const {
  Closest best{Vector3d::Zero(), std::numeric_limits<double>::infinity(), 0};
  int owner = 0;
  for (const int triangle : triangles) {
    const Closest here = closest(triangle, p);
    if (here.squared < best.squared) {
      best = here;
      owner = triangle;
    }
  }
  const Vector3d& normal = pseudonormal_[owner][best.feature];
  const double distance = std::sqrt(best.squared);
  return {best.point, normal, (p - best.point).dot(normal) < 0 ? -distance : distance};
}

int TriangleCollider::cell_at(const Vector3d& p) const {
  const Vector3d scaled = (p - low_).cwiseProduct(inverse_cell_size_);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(scaled[axis] >= 0 && scaled[axis] < resolution)) return outside;
  }
  return cell_[cell_index(scaled.cast<int>())];
}

TriangleCollider::Nearest TriangleCollider::nearest(const Vector3d& p) const {
  const int cell = cell_at(p);
  if (cell != outside) {
    Nearest found = nearest_among(lists_[cell], p);
    if (!convex_ || found.signed_distance <= 0) return found;
  }
  return nearest_by_all(p);
}

int TriangleCollider::least_behind(std::span<const int> list, const Vector3d& p,
                                   double& distance) const {
  const double px = p.x(), py = p.y(), pz = p.z();
  distance = -std::numeric_limits<double>::infinity();
  int nearest = list[0];
  for (const int triangle : list) {
    const double* t = planes_[triangle].data();
    const double here = t[0] * px + t[1] * py + t[2] * pz - t[3];
    if (here > distance) {
      distance = here;
      nearest = triangle;
    }
  }
  return nearest;
}

bool TriangleCollider::touches(std::span<const int> list, const Vector3d& p, double depth,
                               Eigen::Index v, Memory& memory, ContactPlane& plane) const {
  if (!convex_) {
    const Nearest nearest = nearest_among(list, p);
    if (!(nearest.signed_distance < -depth)) return false;
    plane.normal = (nearest.point - p) / -nearest.signed_distance;
    plane.offset = plane.normal.dot(nearest.point);
    return true;
  }
  double distance = 0;
  const double* least = planes_[least_behind(list, p, distance)].data();
  for (int number = 0; number < 4; ++number) memory(v, number) = least[number];
  plane.normal = {least[0], least[1], least[2]};
  plane.offset = least[3];
  return distance < -depth;
}

void TriangleCollider::show_outside(const Vector3d& p, Memory::RowXpr witness) const {
  const Vector3d high = low_ + resolution * cell_size_;
  Eigen::Index axis = 0;
  if (const double beyond = (p - high).cwiseMax(low_ - p).maxCoeff(&axis); beyond > 0) {
    const bool above = p[axis] > high[axis];
    witness << 0, 0, 0, above ? high[axis] : -low_[axis];
    witness[axis] = above ? 1 : -1;
  }
}

void TriangleCollider::find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass,
                            double depth, Memory& memory, std::vector<ContactPlane>& planes,
                            WorkCounters& work) const {
  planes.clear();
  for (Eigen::Index first = 0; first < x.cols(); first += asked_at_once) {
    const Eigen::Index end = std::min(first + asked_at_once, x.cols());
    if (end == first + asked_at_once && outside_known(memory, x, first, depth)) continue;
    for (Eigen::Index v = first; v < end; ++v) {
      if (inverse_mass[v] == 0 || in_front(memory, x, v, depth)) continue;
      const Vector3d p = x.col(v);
      const int cell = cell_at(p);
      if (cell == outside) {
        show_outside(p, memory.row(v));
        continue;
      }
      const std::vector<int>& list = lists_[cell];
      work.triangle_tests += std::ssize(list);
      ContactPlane& plane = planes.emplace_back();  // filled in place: copying it stalls
      plane.vertex = static_cast<int>(v);
      if (!touches(list, p, depth, v, memory, plane)) planes.pop_back();
    }
  }
}

bool TriangleCollider::plane_at(const Vector3d& p, ContactPlane& plane, WorkCounters& work) const {
  const int cell = cell_at(p);
  if (cell == outside) return false;
  const std::vector<int>& list = lists_[cell];
  work.triangle_tests += std::ssize(list);
  if (convex_) {
    double unused = 0;
    const Eigen::RowVector4d& least = planes_[least_behind(list, p, unused)];
    plane.normal = least.head<3>();
    plane.offset = least[3];
    return true;
  }
  const Nearest nearest = nearest_among(list, p);
  const double distance = nearest.signed_distance;
  // At the surface itself the way there has no direction.
  plane.normal = std::abs(distance) > 1e-9 * cell_size_.norm()
                     ? Vector3d((p - nearest.point) / distance)
                     : nearest.normal;
  plane.offset = plane.normal.dot(nearest.point);
  return true;
}

}  // namespace inextensible
