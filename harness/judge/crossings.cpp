#include "harness/judge/crossings.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace harness {

using Eigen::Vector3d;
using inextensible::TriangleMesh;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Vector3d normal_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a).normalized();
}

// Where the line from + t way goes through a triangle (Moeller and Trumbore 1997); `never`: not.
double meets(const TriangleMesh& mesh, const std::array<int, 3>& triangle, const Vector3d& from,
             const Vector3d& way) {
  const Vector3d& a = mesh.vertices[triangle[0]];
  const Vector3d e1 = mesh.vertices[triangle[1]] - a, e2 = mesh.vertices[triangle[2]] - a;
  const Vector3d p = way.cross(e2), s = from - a, q = s.cross(e1);
  const double det = e1.dot(p);
  if (det == 0) return never;
  const double u = s.dot(p) / det, v = way.dot(q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 ? e2.dot(q) / det : never;
}

// The shortest way from the middle of a face straight through the body; at most 250 faces are
// tried, and ten million pairs of faces.
double thickness_of(const TriangleMesh& mesh) {
  double least = never;
  const std::size_t faces = mesh.triangles.size(),
                    stride = 1 + faces / std::clamp<std::size_t>(10'000'000 / (faces + 1), 10, 250);
  for (std::size_t i = 0; i < faces; i += stride) {
    const auto& face = mesh.triangles[i];
    const Vector3d inwards = -normal_of(mesh, face);
    const Vector3d middle =
        (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
    for (std::size_t k = 0; k < faces; ++k) {
      const double way = k == i ? never : meets(mesh, mesh.triangles[k], middle, inwards);
      if (way > 0) least = std::min(least, way);
    }
  }
  return least;
}

}  // namespace

Crossings::Crossings(const Problem& problem) : problem_(problem) {
  const auto* body = dynamic_cast<const inextensible::TriangleCollider*>(problem.collider());
  if (!body) return;
  body_ = &body->mesh();
  thickness_ = thickness_of(*body_);
  crossed_.assign(static_cast<std::size_t>(problem.vertices()), 0);
}

int Crossings::vertices() const { return static_cast<int>(std::ranges::count(crossed_, char{1})); }

Positions Crossings::in_body_frame(const State& state) const {
  Positions x = state.x;
  if (const BodyMotion& motion = problem_.body_motion()) {
    const Pose back = motion(state.time).inverse();
    for (auto column : x.colwise()) column = back(column);
  }
  return x;
}

void Crossings::before(const State& state) {
  if (body_) from_ = in_body_frame(state);
}

void Crossings::after(const State& state) {
  if (!body_) return;
  const Positions to = in_body_frame(state);
  constexpr double nearly = 0.8;
  for (Eigen::Index v = 0; v < to.cols(); ++v) {
    if (!((to.col(v) - from_.col(v)).norm() >= nearly * thickness_)) continue;
    if (passes_through(from_.col(v), to.col(v))) crossed_[v] = 1;
  }
}

// The way is lengthened a little at both ends, for vertices that lie on the surface.
bool Crossings::passes_through(const Vector3d& from, const Vector3d& to) const {
  constexpr double opposite = -0.5;  // cosine
  const double more = 0.1 * thickness_ / (to - from).norm();
  std::vector<Vector3d> normals;
  for (const auto& triangle : body_->triangles) {
    const double at = meets(*body_, triangle, from, to - from);
    if (at >= -more && at <= 1 + more) normals.push_back(normal_of(*body_, triangle));
  }
  for (const Vector3d& a : normals)
    for (const Vector3d& b : normals)
      if (a.dot(b) < opposite) return true;
  return false;
}

}  // namespace harness
