#include "solvers/problem/closed_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
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

// Whether vertex v is no deeper than `depth` behind the plane in row first_row + v.
inline bool in_front(const Collider::Memory& memory, Eigen::Index first_row,
                     const Eigen::Matrix3Xd& x, Eigen::Index v, double depth) {
  const double *plane = memory.data() + 4 * (first_row + v), *p = x.data() + 3 * v;
  return plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] - plane[3] >= -depth;
}

constexpr Eigen::Index asked_at_once = 8;

// The same of all vertices from first to first + asked_at_once, without a branch.
inline bool outside_known(const Collider::Memory& memory, Eigen::Index first_row,
                          const Eigen::Matrix3Xd& x, Eigen::Index first, double depth) {
  std::int64_t behind = 0;
  for (Eigen::Index i = 0; i < asked_at_once; ++i)
    behind += in_front(memory, first_row, x, first + i, depth) ? 0 : 1;
  return behind == 0;
}

const Vector3d& corner(const TriangleMesh& mesh, int triangle, int i) {
  return mesh.vertices[mesh.triangles[triangle][i]];
}

}  // namespace

TriangleSides sides_of(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 3>> at;  // lower end, higher end, side
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      at.push_back({low, high, static_cast<int>(at.size())});
    }
  std::ranges::sort(at);
  TriangleSides found{std::vector<int>(at.size()), 0, 0, 2};
  for (std::size_t first = 0, end = 0; first < at.size(); first = end) {
    const auto [low, high, unused] = at[first];
    while (end < at.size() && at[end][0] == low && at[end][1] == high) ++end;
    for (std::size_t k = first; k < end; ++k)
      found.twin[at[k][2]] = at[k + 1 < end ? k + 1 : first][2];
    if (end - first != 2 && found.faces == 2)
      found = {std::move(found.twin), low, high, static_cast<int>(end - first)};
  }
  return found;
}

std::vector<int> pieces_of(std::size_t vertices, const std::vector<std::array<int, 3>>& triangles) {
  std::vector<int> root(vertices), number(vertices, -1), piece;
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& [a, b, c] : triangles) root[root_of(b)] = root[root_of(c)] = root_of(a);
  for (int v = 0, found = 0; v < static_cast<int>(vertices); ++v) {
    int& of_root = number[root_of(v)];
    piece.push_back(of_root < 0 ? of_root = found++ : of_root);
  }
  return piece;
}

ClosedSurface::ClosedSurface(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  find_pseudonormals();
  check_orientation();
  lay_out_grid();
}

// A face's own normal; the sum of both faces' at an edge; the angle-weighted sum at a corner.
// convex_: whether no edge is reentrant.
void ClosedSurface::find_pseudonormals() {
  const TriangleSides sides = sides_of(mesh_.triangles);
  if (sides.faces != 2)
    throw std::invalid_argument("collider: edge (" + std::to_string(sides.a) + ", " +
                                std::to_string(sides.b) + ") has " + std::to_string(sides.faces) +
                                " triangles, a closed mesh has 2");
  std::vector<Vector3d> at_vertex(mesh_.vertices.size(), Vector3d::Zero());
  pseudonormal_.resize(mesh_.triangles.size());
  for (int f = 0; f < triangles(); ++f) {
    std::array<Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = corner(mesh_, f, i);
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    pseudonormal_[f][0] = normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d next = (p[(i + 1) % 3] - p[i]).normalized(),
                     last = (p[(i + 2) % 3] - p[i]).normalized();
      at_vertex[mesh_.triangles[f][i]] += std::acos(std::clamp(next.dot(last), -1.0, 1.0)) * normal;
    }
  }
  convex_ = true;
  for (int f = 0; f < triangles(); ++f)
    for (int i = 0; i < 3; ++i) {
      const int other = sides.twin[3 * f + i] / 3;
      const Vector3d &first = pseudonormal_[std::min(f, other)][0],
                     &second = pseudonormal_[std::max(f, other)][0];
      pseudonormal_[f][1 + i] = (first + second).normalized();
      pseudonormal_[f][4 + i] = at_vertex[mesh_.triangles[f][i]].normalized();
      const Vector3d &here = corner(mesh_, f, i), opposite = corner(mesh_, f, (i + 2) % 3) - here;
      convex_ = convex_ && opposite.dot(first) <= 1e-9 * here.norm();
    }
}

// A surface without reentrant edges that covers all directions from a point behind its faces, and
// each of them once, is convex (Tietze 1928, Nakajima 1928).
void ClosedSurface::check_orientation() {
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
  if (!(volume > 0))
    throw std::invalid_argument(
        "collider: the mesh is inside out; its triangles must be counter-clockwise seen from "
        "outside");
}

void ClosedSurface::lay_out_grid() {
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : mesh_.vertices) box.extend(v);
  const Vector3d margin =
      Vector3d::Constant(1e-9 * box.sizes().norm());  // no vertex on the grid's own border
  low_ = box.min() - margin;
  cell_size_ = (box.max() + margin - low_) / resolution;
  inverse_cell_size_ = cell_size_.cwiseInverse();
  for (int f = 0; f < triangles(); ++f) {
    const Vector3d& normal = pseudonormal_[f][0];
    planes_.emplace_back(normal.x(), normal.y(), normal.z(), normal.dot(corner(mesh_, f, 0)));
  }
  std::vector<int> all(triangles());
  std::iota(all.begin(), all.end(), 0);
  cell_.assign(resolution * resolution * resolution, outside);
  lists_.add(all);  // deep
  convex_ ? refine_planes(Eigen::Vector3i::Zero(), resolution, all)
          : refine(Eigen::Vector3i::Zero(), resolution, all, balls_around_triangles());
}

ClosedSurface::Balls ClosedSurface::balls_around_triangles() const {
  Balls balls(triangles(), 4);
  for (int f = 0; f < triangles(); ++f) {
    const Vector3d middle = (corner(mesh_, f, 0) + corner(mesh_, f, 1) + corner(mesh_, f, 2)) / 3;
    balls.row(f) << middle.transpose(), 0;
    for (int i = 0; i < 3; ++i)
      balls(f, 3) = std::max(balls(f, 3), (corner(mesh_, f, i) - middle).norm());
  }
  return balls;
}

std::size_t ClosedSurface::cell_index(const Eigen::Vector3i& cell) const {
  return (cell[2] * resolution + cell[1]) * resolution + cell[0];
}

void ClosedSurface::fill(const Eigen::Vector3i& cell, int size, int list) {
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) cell_[cell_index(cell + Eigen::Vector3i(i, j, k))] = list;
}

// candidates: every plane that some point of the block of size^3 cells that begins at `cell` is
// least behind. Those that it is behind farther than one of these all over the block go: tried are
// planes of its corners and its centre. A block in front of one plane needs no other.
void ClosedSurface::refine_planes(const Eigen::Vector3i& cell, int size,
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
    fill(cell, size, lists_.add(kept));
    return;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3i offset(octant & 1, (octant >> 1) & 1, octant >> 2);
    refine_planes(cell + size / 2 * offset, size / 2, kept);
  }
}

// candidates: every triangle that is nearest to some point of the block of size^3 cells that begins
// at `cell`, by ascending number. Balls around triangles decide where they can.
void ClosedSurface::refine(const Eigen::Vector3i& cell, int size,
                           const std::vector<int>& candidates, const Balls& balls) {
  const Vector3d centre =
      low_ + cell_size_.cwiseProduct(cell.cast<double>() + Vector3d::Constant(0.5 * size));
  const double half_diagonal = 0.5 * size * cell_size_.norm(), slack = 1e-9 * half_diagonal;
  const Eigen::ArrayXd to_middle =
      ((balls.col(0) - centre.x()).square() + (balls.col(1) - centre.y()).square() +
       (balls.col(2) - centre.z()).square())
          .sqrt();
  const Eigen::ArrayXd at_least = to_middle - balls.col(3);
  const Eigen::Index count = to_middle.size();
  Eigen::ArrayXd known = Eigen::ArrayXd::Constant(count, -1);  // squared distances, once asked for
  const auto squared = [&](Eigen::Index i) {
    if (known[i] < 0) known[i] = closest(candidates[i], centre).squared;
    return known[i];
  };
  const double most = to_middle.minCoeff() + slack;
  double least = std::numeric_limits<double>::infinity();
  int nearest = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (at_least[i] > most || !(squared(i) < least)) continue;
    least = known[i];
    nearest = candidates[i];
  }
  least = std::sqrt(least);
  if (least > half_diagonal) {  // the surface does not pass through
    if (nearest_among({&nearest, 1}, centre).signed_distance > 0) return;
    if (least > half_diagonal + deep_cells * cell_size_.norm()) return fill(cell, size, deep);
  }
  const double bound = (least + 2 * half_diagonal) * (1 + 1e-12);
  const auto is_within = [&](Eigen::Index i) {
    if (to_middle[i] < bound - slack) return true;
    if (at_least[i] > bound + slack) return false;
    return (size > 1 && balls(i, 3) < 0.3 * half_diagonal) || std::sqrt(squared(i)) <= bound;
  };
  std::vector<int> kept;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!is_within(i)) continue;
    kept.push_back(candidates[i]);
    rows.push_back(i);
  }
  if (size == 1) {
    cell_[cell_index(cell)] = lists_.add(kept);
    return;
  }
  const Balls around = balls(rows, Eigen::all);
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3i offset(octant & 1, (octant >> 1) & 1, octant >> 2);
    refine(cell + size / 2 * offset, size / 2, kept, around);
  }
}

// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
ClosedSurface::Closest ClosedSurface::closest(int triangle, const Vector3d& p) const {
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

ClosedSurface::Nearest ClosedSurface::nearest_among(std::span<const int> triangles,
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

int ClosedSurface::cell_at(const Vector3d& p) const {
  const Vector3d scaled = (p - low_).cwiseProduct(inverse_cell_size_);
  for (int axis = 0; axis < 3; ++axis)
    if (!(scaled[axis] >= 0 && scaled[axis] < resolution)) return outside;
  return cell_[cell_index(scaled.cast<int>())];
}

ClosedSurface::Nearest ClosedSurface::nearest(const Vector3d& p) const {
  const int cell = cell_at(p);
  if (cell != outside) {
    Nearest found = nearest_among(lists_[cell], p);
    if (!convex_ || found.signed_distance <= 0) return found;
  }
  return nearest_by_all(p);
}

int ClosedSurface::least_behind(std::span<const int> list, const Vector3d& p,
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

bool ClosedSurface::touches(std::span<const int> list, const Vector3d& p, double depth,
                            Eigen::Index row, Memory& memory, ContactPlane& plane) const {
  if (!convex_) {
    const Nearest nearest = nearest_among(list, p);
    if (!(nearest.signed_distance < -depth)) return false;
    plane.normal = (nearest.point - p) / -nearest.signed_distance;
    plane.offset = plane.normal.dot(nearest.point);
    return true;
  }
  double distance = 0;
  const Eigen::RowVector4d& least = planes_[least_behind(list, p, distance)];
  memory.row(row) = least;
  plane.normal = least.head<3>();
  plane.offset = least[3];
  return distance < -depth;
}

void ClosedSurface::show_outside(const Vector3d& p, Memory::RowXpr witness) const {
  const Vector3d high = low_ + resolution * cell_size_;
  Eigen::Index axis = 0;
  if (const double beyond = (p - high).cwiseMax(low_ - p).maxCoeff(&axis); beyond > 0) {
    const bool above = p[axis] > high[axis];
    witness << 0, 0, 0, above ? high[axis] : -low_[axis];
    witness[axis] = above ? 1 : -1;
  }
}

void ClosedSurface::find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass,
                         double depth, Eigen::Index first_row, Memory& memory,
                         std::vector<ContactPlane>& planes, WorkCounters& work) const {
  for (Eigen::Index first = 0; first < x.cols(); first += asked_at_once) {
    const Eigen::Index end = std::min(first + asked_at_once, x.cols());
    if (end == first + asked_at_once && outside_known(memory, first_row, x, first, depth)) continue;
    // First the cells, so that their lists come from memory side by side.
    std::array<int, asked_at_once> cells{}, vertices{};
    int asked = 0;
    for (Eigen::Index v = first; v < end; ++v) {
      if (inverse_mass[v] == 0 || in_front(memory, first_row, x, v, depth)) continue;
      const int cell = cell_at(x.col(v));
      if (cell == outside) {
        show_outside(x.col(v), memory.row(first_row + v));
        continue;
      }
      __builtin_prefetch(lists_[cell].data());
      cells[asked] = cell;
      vertices[asked++] = static_cast<int>(v);
    }
    for (int i = 0; i < asked; ++i) {
      const std::span<const int> list = lists_[cells[i]];
      work.triangle_tests += std::ssize(list);
      ContactPlane& plane = planes.emplace_back();  // filled in place: copying it stalls
      plane.vertex = vertices[i];
      if (!touches(list, x.col(vertices[i]), depth, first_row + vertices[i], memory, plane))
        planes.pop_back();
    }
  }
}

bool ClosedSurface::plane_at(const Vector3d& p, ContactPlane& plane, WorkCounters& work) const {
  const int cell = cell_at(p);
  if (cell == outside) return false;
  const std::span<const int> list = lists_[cell];
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
