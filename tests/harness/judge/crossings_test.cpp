#include "harness/judge/crossings.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace harness {
namespace {

using Eigen::Vector3d;
using inextensible::TriangleMesh;

TriangleMesh box(const Vector3d& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 4 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                               i & 1 ? half.z() : -half.z());
  for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{
           {0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

// How many of single vertices with these ways cross the body.
int crossed(const TriangleMesh& body, const std::vector<std::pair<Vector3d, Vector3d>>& ways,
            inextensible::BodyMotion motion = {}) {
  inextensible::ProblemParts parts;
  parts.mass.assign(ways.size(), 1);
  parts.collider = std::make_shared<inextensible::TriangleCollider>(body, 0);
  parts.body_motion = std::move(motion);
  const inextensible::Problem problem(parts);
  inextensible::State before{inextensible::Positions(3, ways.size()), {}}, after = before;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    before.x.col(i) = ways[i].first;
    after.x.col(i) = ways[i].second;
  }
  after.time = 1;
  Crossings crossings(problem);
  crossings.before(before);
  crossings.after(after);
  return crossings.vertices();
}

// Through a plate, from its surface too; not beside it, into it, along it, or over its rim.
TEST(Crossings, AreWaysThroughThePlate) {
  const TriangleMesh plate = box({0.5, 0.0002, 0.5});
  for (const auto& [from, to, wanted] : std::vector<std::tuple<Vector3d, Vector3d, int>>{
           {{0.1, 0.01, 0.2}, {0.1, -0.01, 0.2}, 1},
           {{0.1, -0.3, 0.2}, {-0.2, 0.1, 0.2}, 1},
           {{0.1, 0.0002, 0.2}, {0.1, -0.0002, 0.2}, 1},
           {{0.6, 0.01, 0.2}, {0.6, -0.01, 0.2}, 0},
           {{0.1, 0.01, 0.2}, {0.1, 0.0001, 0.2}, 0},
           {{0.1, 0.0002, 0.2}, {0.4, 0.0002, 0.2}, 0},
           {{0.45, 0.001, 0.2}, {0.55, 0.0005, 0.2}, 0}})
    EXPECT_EQ(crossed(plate, {{from, to}}), wanted) << from.transpose() << " to " << to.transpose();
}

TEST(Crossings, AreSeenWhereThePlateMoves) {
  const Vector3d still(0.1, 0.05, 0.2);
  const auto rise = [](double time) {
    return inextensible::Pose{Eigen::Matrix3d::Identity(), Vector3d(0, 0.1 * time, 0)};
  };
  EXPECT_EQ(crossed(box({0.5, 0.002, 0.5}), {{still, still}}), 0);
  EXPECT_EQ(crossed(box({0.5, 0.002, 0.5}), {{still, still}}, rise), 1);
}

// Chords of a ball: through its middle they cross, near its surface they cut a bulge.
TEST(Crossings, AreNotChordsOfABulge) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const TriangleMesh ball = inextensible::icosphere(Vector3d::Zero(), 1, 3);
  for (const auto& [turn, wanted] : {std::pair(0.2, 0), {0.9, 0}, {3.0, 20}}) {
    std::vector<std::pair<Vector3d, Vector3d>> ways;
    for (int i = 0; i < 20; ++i) {
      const Vector3d from = Vector3d(normal(random), normal(random), normal(random)).normalized();
      ways.emplace_back(1.01 * from,
                        Eigen::AngleAxisd(turn, from.unitOrthogonal()) * (1.01 * from));
    }
    EXPECT_EQ(crossed(ball, ways), wanted) << turn;
  }
}

}  // namespace
}  // namespace harness
