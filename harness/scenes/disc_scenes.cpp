// Cusick's drape test: a disc of cloth on a smaller round table.
#include <cmath>
#include <stdexcept>

#include "harness/scenes/cloth_mesh.h"
#include "harness/scenes/fabrics.h"

namespace harness {
namespace {

// The quads of a square grid whose middle lies in the disc: its area is the disc's, but for what
// the grid leaves open. In the plane y = 0, pinned where the table is.
PinnedMesh disc_of(const SceneParameters& p) {
  const auto n = whole(p);
  const double radius = p.at("radius"), link = 2 * radius / (n - 1);
  const auto place = [&](double index) { return link * (index - 0.5 * (n - 1)); };
  const auto quad = [&](int i, int j) {
    return i >= 0 && j >= 0 && i + 1 < n && j + 1 < n &&
           std::hypot(place(i + 0.5), place(j + 0.5)) <= radius;
  };
  PinnedMesh disc;
  std::vector<int> number(n * n, -1);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (!quad(i, j) && !quad(i - 1, j) && !quad(i, j - 1) && !quad(i - 1, j - 1)) continue;
      number[i * n + j] = static_cast<int>(disc.mesh.vertices.size());
      disc.mesh.vertices.emplace_back(place(j), 0, place(i));
      disc.held.push_back(std::hypot(place(i), place(j)) <= p.at("table"));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int* at = number.data() + i * n + j;
      if (quad(i, j)) disc.mesh.quads.push_back({at[0], at[1], at[n + 1], at[n]});
    }
  }
  return disc;
}

// Height at the start, m: a few waves of unlike length, so that no symmetry holds folds back.
double unevenness(const SceneParameters& p, double x, double z) {
  const double r = std::hypot(x, z), table = p.at("table"), angle = std::atan2(z, x);
  const double out = std::max(0.0, (r - table) / (p.at("radius") - table));
  return p.at("uneven") * out * out *
         (std::cos(3 * angle + 0.4) + std::cos(5 * angle + 1.9) + std::cos(7 * angle + 0.9));
}

Scene build_cusick(const SceneParameters& p) {
  if (!(p.at("table") < p.at("radius")))
    throw std::invalid_argument("a table of " + std::to_string(p.at("table")) +
                                " m under a disc of " + std::to_string(p.at("radius")) +
                                " m: nothing hangs over");
  Draft draft = cloth_draft(disc_of(p), p);
  inextensible::Positions& x = draft.scene.start.x;
  for (Eigen::Index v = 0; v < x.cols(); ++v) x(1, v) = unevenness(p, x(0, v), x(2, v));
  draft.scene.size = 2 * p.at("radius");
  return finished(std::move(draft));
}

}  // namespace

std::vector<SceneType> disc_scenes() {
  const Fabric& cotton = fabric("cotton");
  return {
      {.name = "cusick",
       .summary =
           "a disc of cotton broadcloth hangs over the edge of a round table (Cusick's drape "
           "test)",
       .parameters = with_cloth_parameters(
           {{"n", 31, "vertices along the disc's diameter", 7, 1000, true},
            {"radius", 0.15, "of the disc, m", 0, 1e6},
            {"table", 0.09, "radius on which it is held, m", 0, 1e6},
            {"uneven", 2e-4, "height of waves along the rim at the start, m", zero_too, 1e-2}},
           {.density = cotton.density, .shear = fabric_shear, .bending = cotton.bending, .drag = 1},
           1.5),
       .build = build_cusick,
       .counts = [](const SceneParameters& p) { return count_cloth(disc_of(p)); },
       .like = "patch"}};
}

}  // namespace harness
