// The collider on a mesh that is not convex, where the sign of the distance is hard: against
// closest points by another formula and the winding number.
#include "solvers/problem/triangle_collider.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/contact.h"
#include "support/effort.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using Eigen::Vector3d;
using testing::Random;

// An icosphere with every vertex pulled towards the centre by its own factor: spikes and pits.
TriangleMesh spiky(Random& random, int subdivisions) {
  TriangleMesh mesh = icosphere(Vector3d::Zero(), 1, subdivisions);
  for (Vector3d& v : mesh.vertices) v *= testing::uniform(random, 0.4, 1);
  return mesh;
}

// The foot on the plane if it lies in the triangle, else the nearest point of the three sides.
double distance_to_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                            const Vector3d& p) {
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Vector2d s = (sides.transpose() * sides).ldlt().solve(sides.transpose() * (p - a));
  if (s[0] >= 0 && s[1] >= 0 && s[0] + s[1] <= 1) return (a + sides * s - p).norm();
  double least = std::numeric_limits<double>::infinity();
  const std::array<Vector3d, 4> corner{a, b, c, a};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d d = corner[i + 1] - corner[i];
    const double t = std::clamp((p - corner[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (corner[i] + t * d - p).norm());
  }
  return least;
}

// Sum of the triangles' solid angles (van Oosterom and Strackee 1983) over 4 pi: 1 inside, 0
// outside.
double winding_number(const TriangleMesh& mesh, const Vector3d& p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p,
                   c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * M_PI);
}

Vector3d random_point(Random& random, double size) {
  return {testing::uniform(random, -size, size), testing::uniform(random, -size, size),
          testing::uniform(random, -size, size)};
}

TEST(TriangleCollider, DistanceAndSignAreRightOnAMeshThatIsNotConvex) {
  int inside = 0, outside = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const TriangleMesh mesh = spiky(random, 2);
    const TriangleCollider collider(mesh, 0.3);
    for (int i = 0; i < testing::trials(3000); ++i) {
      const Vector3d p = random_point(random, i % 3 ? 0.8 : 1.2);  // also beyond the grid's box
      double distance = std::numeric_limits<double>::infinity();
      for (const auto& t : mesh.triangles) {
        distance = std::min(distance, distance_to_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                           mesh.vertices[t[2]], p));
      }
      const auto found = collider.nearest(p);
      ASSERT_NEAR(std::abs(found.signed_distance), distance, 1e-12) << p.transpose();
      ASSERT_NEAR((found.point - p).norm(), distance, 1e-12);
      ASSERT_NEAR(found.signed_distance, collider.nearest_by_all(p).signed_distance, 1e-14);
      if (distance < 1e-9) continue;
      const bool is_inside = winding_number(mesh, p) > 0.5;
      ++(is_inside ? inside : outside);
      ASSERT_EQ(found.signed_distance < 0, is_inside) << p.transpose();
    }
  }
  EXPECT_GT(inside, testing::trials(1000));
  EXPECT_GT(outside, testing::trials(1000));
}

// The least signed distance of some random vertices after a collision filter's pass.
double deepest_after_push_out(const TriangleMesh& mesh, double friction, Random& random) {
  const auto shared = std::make_shared<const TriangleCollider>(mesh, friction);
  const TriangleCollider& collider = *shared;
  const int n = testing::trials(5000);
  Eigen::Matrix3Xd start(3, n), x(3, n);
  int inside = 0;
  for (int v = 0; v < n; ++v) {
    x.col(v) = random_point(random, 1);
    start.col(v) = x.col(v) + random_point(random, 0.3);
    inside += collider.nearest_by_all(x.col(v)).signed_distance < 0;
  }
  const Eigen::Matrix3Xd before = x;
  WorkCounters work;
  testing::push_out(shared, start, x, work);
  EXPECT_EQ(work.contacts, inside);
  double deepest = 0;
  for (int v = 0; v < n; ++v) {
    deepest = std::min(deepest, collider.nearest_by_all(x.col(v)).signed_distance);
    if (collider.nearest_by_all(before.col(v)).signed_distance >= 0) {
      EXPECT_EQ(x.col(v), before.col(v)) << "a vertex outside was moved";
    }
  }
  return deepest;
}

// The planes of a convex mesh against the nearest points of all its triangles. Without friction a
// vertex goes to its nearest point.
TEST(TriangleCollider, OfAConvexMeshGoesToTheNearestPoint) {
  for (const int subdivisions : {0, 1, 3}) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(seed);
      TriangleMesh mesh = icosphere(Vector3d::Zero(), 0.9, subdivisions);
      // An affine image of a convex body is convex.
      Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
      for (int i = 0; i < 3; ++i) stretch.col(i) += random_point(random, 0.3);
      ASSERT_GT(stretch.determinant(), 0);
      for (Vector3d& v : mesh.vertices) v = (stretch * v).eval();
      const auto shared = std::make_shared<const TriangleCollider>(mesh, 0);
      const TriangleCollider& collider = *shared;
      const int n = testing::trials(2000);
      Eigen::Matrix3Xd before(3, n);
      for (int v = 0; v < n; ++v) before.col(v) = random_point(random, 1.3);
      Eigen::Matrix3Xd x = before;
      WorkCounters work;
      testing::push_out(shared, before, x, work);
      int inside = 0;
      for (int v = 0; v < n; ++v) {
        const auto nearest = collider.nearest_by_all(before.col(v));
        inside += nearest.signed_distance < 0;
        // Either of two faces at the same distance will do.
        EXPECT_NEAR((x.col(v) - before.col(v)).norm(), std::max(0.0, -nearest.signed_distance),
                    1e-12)
            << before.col(v).transpose();
        EXPECT_GE(collider.nearest_by_all(x.col(v)).signed_distance, -1e-12);
      }
      EXPECT_GT(inside, testing::trials(100));
      EXPECT_EQ(work.contacts, inside);
    }
  }
}

TEST(TriangleCollider, PushOutLeavesNothingInsideWhateverTheFriction) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Random random(seed);
    const auto sphere = [](int subdivisions) {
      return icosphere(Vector3d::Zero(), 0.9, subdivisions);
    };
    for (const TriangleMesh& mesh : {sphere(0), sphere(3), spiky(random, 2)}) {
      for (const double friction : {0.0, 0.3, 10.0}) {
        EXPECT_GE(deepest_after_push_out(mesh, friction, random), -1e-12)
            << "seed " << seed << ", friction " << friction << ", " << mesh.triangles.size();
      }
    }
  }
}

TEST(TriangleCollider, RefusesAMeshThatIsInsideOut) {
  TriangleMesh mesh = icosphere(Vector3d::Zero(), 1, 1);
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THROW(TriangleCollider(mesh, 0), std::invalid_argument);
}

}  // namespace
}  // namespace inextensible
