// The collider on a mesh that is not convex, where the sign of the distance is hard: against
// closest points by another formula and the winding number.
#include "solvers/problem/triangle_collider.h"

#include <Eigen/Geometry>
#include <ctime>

#include "support/motion.h"

namespace inextensible {
namespace {

using Eigen::Vector3d, testing::Random, testing::random_vector;

// An icosphere with every vertex pulled towards the centre by its own factor: spikes and pits.
TriangleMesh spiky(Random& random, int subdivisions) {
  TriangleMesh mesh = icosphere(Vector3d::Zero(), 1, subdivisions);
  for (Vector3d& v : mesh.vertices) v *= testing::uniform(random, 0.4, 1);
  return mesh;
}

// A wide block just below.
void add_floor(TriangleMesh& mesh) { add_block(mesh, {-50, -100, -50}, {50, -1.05, 50}); }

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

// Sum of solid angles (van Oosterom and Strackee 1983) over 4 pi: 1 inside, 0 outside.
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

TEST(TriangleCollider, DistanceAndSignAreRightOnAMeshThatIsNotConvex) {
  int inside = 0, outside = 0, all = 0;
  testing::for_seeds(4, [&](testing::Random& random, std::uint64_t seed) {
    TriangleMesh mesh = spiky(random, 2);
    if (seed % 2 == 1) add_floor(mesh);
    const TriangleCollider collider(mesh, 0.3);
    for (int i = 0; i < testing::trials(3000); ++i, ++all) {
      const Vector3d p = random_vector(random, i % 3 ? 0.8 : 1.2);  // also beyond the grid's box
      double distance = std::numeric_limits<double>::infinity();
      for (const auto& t : mesh.triangles)
        distance = std::min(distance, distance_to_triangle(mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                           mesh.vertices[t[2]], p));
      const auto found = collider.nearest(p);
      ASSERT_NEAR(std::abs(found.signed_distance), distance, 1e-12) << p.transpose();
      ASSERT_NEAR((found.point - p).norm(), distance, 1e-12);
      ASSERT_NEAR(found.signed_distance, collider.nearest_by_all(p).signed_distance, 1e-14);
      if (distance < 1e-9) continue;
      const bool is_inside = winding_number(mesh, p) > 0.5;
      ++(is_inside ? inside : outside);
      ASSERT_EQ(found.signed_distance < 0, is_inside) << p.transpose();
    }
  });
  EXPECT_GT(12 * inside, all);
  EXPECT_GT(12 * outside, all);
}

// No vertex is inside after a collision filter's pass, none outside is moved. Onto a convex mesh,
// whose planes are against the nearest points of all its triangles, a vertex goes to its nearest
// point where there is no friction.
TEST(TriangleCollider, PushOutMovesWhatIsInsideToTheSurfaceWhateverTheFriction) {
  testing::for_seeds(3, [](Random& random, std::uint64_t) {
    // An affine image of a convex body is convex.
    const auto ellipsoid = [&random](int subdivisions) {
      TriangleMesh mesh = icosphere(Vector3d::Zero(), 0.9, subdivisions);
      Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
      for (int i = 0; i < 3; ++i) stretch.col(i) += random_vector(random, 0.3);
      EXPECT_GT(stretch.determinant(), 0);
      for (Vector3d& v : mesh.vertices) v = (stretch * v).eval();
      return mesh;
    };
    // No edge of two bodies is reentrant either.
    TriangleMesh two = ellipsoid(1);
    const int one = static_cast<int>(two.vertices.size());
    for (int v = 0; v < one; ++v) {
      two.vertices.push_back(two.vertices[v] + Vector3d(1.4, 0, 0));
      two.vertices[v] -= Vector3d(1.4, 0, 0);
    }
    for (std::size_t f = 0, faces = two.triangles.size(); f < faces; ++f) {
      const auto [i, j, k] = two.triangles[f];
      two.triangles.push_back({i + one, j + one, k + one});
    }
    // And whether they are convex.
    const std::pair<TriangleMesh, bool> meshes[] = {{ellipsoid(0), true},
                                                    {ellipsoid(1), true},
                                                    {ellipsoid(3), true},
                                                    {two, false},
                                                    {spiky(random, 2), false}};
    for (const auto& [mesh, convex] : meshes)
      for (const double friction : {0.0, 0.3, 10.0}) {
        SCOPED_TRACE(std::to_string(mesh.triangles.size()) + " triangles, friction " +
                     std::to_string(friction));
        const auto collider = std::make_shared<const TriangleCollider>(mesh, friction);
        const int n = testing::trials(3000);
        Eigen::Matrix3Xd start(3, n), candidate(3, n);
        for (int v = 0; v < n; ++v) {
          candidate.col(v) = random_vector(random, 1.2);
          start.col(v) = candidate.col(v) + random_vector(random, 0.3);
        }
        Eigen::Matrix3Xd x = candidate;
        WorkCounters work;
        const Problem problem = testing::points(n, collider, false);
        Contacts contacts(problem);
        contacts.begin(start, 0, 1);
        contacts.push_out(x, work);
        int inside = 0;
        for (int v = 0; v < n; ++v) {
          const double distance = collider->nearest_by_all(candidate.col(v)).signed_distance,
                       moved = (x.col(v) - candidate.col(v)).norm();
          inside += distance < 0;
          EXPECT_GE(collider->nearest_by_all(x.col(v)).signed_distance, -1e-12);
          if (distance >= 0) {
            EXPECT_EQ(moved, 0) << candidate.col(v).transpose();
          } else if (convex && friction == 0) {  // either of two faces at the same distance will do
            EXPECT_NEAR(moved, -distance, 1e-12) << candidate.col(v).transpose();
          }
        }
        EXPECT_GT(inside, testing::trials(100));
        EXPECT_EQ(work.contacts, inside);
      }
  });
}

// Points that drift past a body, into it, and past its box.
TEST(TriangleCollider, WhatItRemembersChangesNoAnswer) {
  int found = 0;
  testing::for_seeds(3, [&](Random& random, std::uint64_t) {
    for (const TriangleMesh& mesh : {icosphere(Vector3d::Zero(), 0.6, 2), spiky(random, 1)}) {
      const TriangleCollider collider(mesh, 0);
      constexpr int n = 101;
      const std::vector<double> inverse_mass(n, 1);
      Eigen::Matrix3Xd x(3, n), step(3, n);
      for (int v = 0; v < n; ++v) {
        x.col(v) = random_vector(random, 1.2);
        step.col(v) = random_vector(random, 0.05);
      }
      Collider::Memory memory = collider.nothing_of(n);
      std::vector<ContactPlane> planes, fresh;
      WorkCounters work;
      for (int time = 0; time < testing::trials(60); ++time, x += step) {
        const double depth = time % 3 * 0.05;
        collider.find(x, inverse_mass, depth, memory, planes, work);
        Collider::Memory nothing = collider.nothing_of(n);
        collider.find(x, inverse_mass, depth, nothing, fresh, work);
        ASSERT_EQ(planes.size(), fresh.size());
        for (std::size_t i = 0; i < fresh.size(); ++i) {
          ASSERT_EQ(planes[i].vertex, fresh[i].vertex);
          ASSERT_EQ(planes[i].normal, fresh[i].normal);
        }
        found += static_cast<int>(fresh.size());
      }
    }
  });
  EXPECT_GT(found, testing::trials(100));
}

TEST(TriangleCollider, AFloorLeavesTheCellsOfABodyFine) {
  testing::for_seeds(2, [&](Random& random, std::uint64_t) {
    TriangleMesh mesh = spiky(random, 3);
    const TriangleCollider alone(mesh, 0);
    add_floor(mesh);
    const TriangleCollider both(mesh, 0);
    WorkCounters without, with;
    ContactPlane plane{}, same{};
    for (int i = 0; i < testing::trials(1000); ++i) {
      const Vector3d p = random_vector(random, 0.6);
      const bool near = alone.plane_at(p, plane, without);
      ASSERT_EQ(both.plane_at(p, same, with), near);
      ASSERT_EQ(plane.normal, same.normal);
    }
    EXPECT_GT(without.triangle_tests, 0);
    EXPECT_EQ(with.triangle_tests, without.triangle_tests);
  });
}

// Sixteen times the triangles take little more than 16 times as long, convex or with a dent: each
// against each other would take 256 times. In processor time, which other programs leave alone.
TEST(TriangleCollider, ItsSetUpGrowsAsItsTriangles) {
  for (const double dent : {1.0, 0.9}) {
    const auto seconds = [&](int subdivisions) {
      TriangleMesh mesh = icosphere(Vector3d::Zero(), 1, subdivisions);
      mesh.vertices[0] *= dent;
      std::clock_t least = std::numeric_limits<std::clock_t>::max();
      for (int i = 0; i < 2; ++i) {
        const std::clock_t begin = std::clock();
        const TriangleCollider made(mesh, 0);
        least = std::min(least, std::clock() - begin);
      }
      return static_cast<double>(least) / CLOCKS_PER_SEC;
    };
    EXPECT_LT(seconds(6), 40 * seconds(4)) << dent;
  }
}

TEST(TriangleCollider, RefusesAMeshThatIsInsideOut) {
  TriangleMesh mesh = icosphere(Vector3d::Zero(), 1, 1);
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THROW(TriangleCollider(mesh, 0), std::invalid_argument);
}

}  // namespace
}  // namespace inextensible
