#include "harness/scenes/cloth_draft.h"

#include <algorithm>

namespace harness {

ParameterInfos with_cloth_parameters(const ParameterInfos& own, const ClothDefaults& cloth,
                                     double duration) {
  return joined({own, fabric_parameters(cloth), {duration_info(duration)}});
}

Draft cloth_draft(const PinnedMesh& cloth, const SceneParameters& p) {
  const ClothMesh& mesh = cloth.mesh;
  const auto length = [&](int a, int b) { return (mesh.vertices[a] - mesh.vertices[b]).norm(); };
  const auto held = [&](auto... vertices) { return (cloth.held[vertices] && ...); };
  Draft draft;
  inextensible::ProblemParts& parts = draft.parts;
  Scene& scene = draft.scene;
  const auto n = static_cast<int>(mesh.vertices.size());
  const std::vector<double> area = areas(mesh);
  scene.start.x.resize(3, n);
  scene.start.v.setZero(3, n);
  for (int v = 0; v < n; ++v) {
    scene.start.x.col(v) = mesh.vertices[v];
    if (held(v)) parts.pinned.push_back(v);
    parts.mass.push_back(p.at("density") * area[v]);
    if (p.at("drag") > 0) parts.drag.push_back(p.at("drag") * area[v]);
  }
  parts.gravity = {0, -p.at("gravity"), 0};
  for (const auto& [a, b] : sides_of_quads(mesh)) {
    if (held(a, b)) continue;
    parts.edges.push_back({a, b});
    parts.rest_length.push_back(length(a, b));
  }
  if (p.at("shear") > 0) {
    inextensible::Springs springs;
    const auto join = [&](int a, int b) {
      if (held(a, b)) return;
      springs.edges.push_back({a, b});
      springs.rest_length.push_back(length(a, b));
      springs.stiffness.push_back(p.at("shear"));
    };
    for (const auto& [a, b, c, d] : mesh.quads) {
      join(a, c);
      join(b, d);
    }
    for (const auto& [a, b] : sides_of_triangles(mesh)) join(a, b);
    if (!springs.edges.empty()) parts.shear = std::move(springs);
  }
  if (p.at("bending") > 0) {
    for (const auto& [a, b, c] : yarns_of(mesh)) {
      if (held(a, b, c)) continue;
      const double before = length(a, b), after = length(b, c);
      const double width = area[b] / (0.5 * (before + after));
      parts.bending.push_back(
          inextensible::yarn_bending(a, b, c, before, after, p.at("bending") * width));
    }
  }
  parts.implicit_forces = true;
  for (const auto& [a, b, c, d] : mesh.quads)
    scene.triangles.insert(scene.triangles.end(), {{a, b, d}, {c, d, b}});
  scene.triangles.insert(scene.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  scene.staggered = false;
  scene.duration = p.at("duration");
  return draft;
}

std::pair<int, int> count_cloth(const PinnedMesh& cloth) {
  const std::vector<Side> sides = sides_of_quads(cloth.mesh);
  const auto constrained = std::count_if(sides.begin(), sides.end(), [&](const Side& s) {
    return !cloth.held[s.first] || !cloth.held[s.second];
  });
  return {static_cast<int>(cloth.mesh.vertices.size()), static_cast<int>(constrained)};
}

}  // namespace harness
