// Scenes as they are meant to be, what all of them promise, and invariants of whole runs.
#include "harness/scenes/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/judge/mechanics.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/systems/schur_complement.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::TriangleCollider;

double mirror_defect(const Scene::Mirror& mirror, const Positions& x) {
  const Positions reflected = x - 2 * mirror.normal * (mirror.normal.transpose() * x);
  return (reflected - x(Eigen::all, mirror.image)).colwise().norm().maxCoeff();
}

TEST(EveryScene, StartsAsItPromises) {
  for (const SceneType& type : scene_types()) {
    SCOPED_TRACE(type.name);
    const SceneParameters p = complete_parameters(type, {{"n", 9}});
    const Scene scene = type.build(p);
    EXPECT_EQ(type.counts(p), std::pair(scene.problem->vertices(), scene.problem->constraints()));
    // Cloth that is to hang by itself starts a little uneven.
    EXPECT_LT(strain_range(*scene.problem, scene.start.x).most, scene.staggered ? 1e-12 : 1e-3);
    for (const Scene::Mirror& mirror : scene.mirrors) {
      EXPECT_LT(mirror_defect(mirror, scene.start.x), 1e-12);
      EXPECT_LT(mirror_defect(mirror, scene.start.v), 1e-12);
    }
    std::set<std::pair<int, int>> sides;  // as triangles pass them: one side of the cloth is out
    for (const auto& [a, b, c] : scene.triangles)
      for (const auto& side : {std::pair(a, b), {b, c}, {c, a}})
        EXPECT_TRUE(sides.insert(side).second);
    if (const auto* body = dynamic_cast<const TriangleCollider*>(scene.problem->collider())) {
      for (const auto& place : scene.start.x.colwise())
        EXPECT_GT(body->nearest(place).signed_distance, 0);
    }
    if (type.exact) {
      constexpr double dt = 1e-6;
      const Positions now = type.exact(p, 0), soon = type.exact(p, dt);
      EXPECT_LT((now - scene.start.x).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT(((soon - now) / dt - scene.start.v).cwiseAbs().maxCoeff(), 1e-4);
    }
    EXPECT_TRUE(find_scene(type.kind()));
  }
}

TEST(Drape, HasThePapersSizes) {
  const Scene drape = built_scene("drape", {});
  EXPECT_EQ(drape.problem->vertices(), 5041);
  EXPECT_EQ(drape.problem->constraints(), 9940);
  EXPECT_EQ(drape.problem->shear()->edges.size(), 9800u);
  EXPECT_EQ(drape.problem->collider()->triangles(), 1280);
  const inextensible::EdgeConstraints edges(*drape.problem, 0.01);
  const inextensible::SchurComplement schur(edges, 5041,
                                            inextensible::SymmetricPattern::Triangle::upper);
  EXPECT_EQ(schur.pattern().entries(), 39338);
}

// Rows lie below their pins; marks are the middles of the first and the last row.
TEST(HungPatch, IsThePatchTurnedAboutItsPins) {
  const Scene hung = built_scene("hung_patch", {{"n", 9}, {"tilt", 0.3}, {"side", 2}});
  ASSERT_EQ(hung.marks.size(), 2u);
  EXPECT_EQ(hung.start.x.col(hung.marks[0].vertex), Eigen::Vector3d::Zero());
  EXPECT_NEAR(hung.start.x(1, hung.marks[1].vertex), -2 * std::cos(0.3), 1e-15);
  EXPECT_EQ(hung.marks[1].height, -2);
}

TEST(Icosphere, IsMirrorSymmetric) {
  for (int level = 0; level <= 3; ++level) {
    const auto mesh = inextensible::icosphere(Eigen::Vector3d::Zero(), 0.25, level);
    EXPECT_EQ(mesh.triangles.size(), 20u << (2 * level));
    for (const Eigen::Vector3d& v : mesh.vertices) {
      EXPECT_NEAR(v.norm(), 0.25, 1e-15);
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3d image = v;
        image[axis] = -image[axis];
        EXPECT_TRUE(std::ranges::any_of(
            mesh.vertices, [&](const Eigen::Vector3d& w) { return (w - image).norm() < 1e-14; }));
      }
    }
  }
}

}  // namespace
}  // namespace harness
