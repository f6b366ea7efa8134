#include "harness/scenes/disc_scenes.h"

#include <cmath>
#include <stdexcept>

#include "harness/scenes/cloth_draft.h"
#include "harness/scenes/fabrics.h"

namespace harness {
namespace {

struct Disc {
  ClothMesh mesh;
  std::vector<char> held;  // on the table
};

// The quads of a square grid whose middle lies in the disc: its area is the disc's, but for what
// the grid leaves open. In the plane y = 0.
Disc disc_of(const SceneParameters& p) {
  const auto n = static_cast<int>(p.at("n"));
  const double radius = p.at("radius"), link = 2 * radius / (n - 1);
  const auto place = [&](double index) { return link * (index - 0.5 * (n - 1)); };
  const auto quad = [&](int i, int j) {
    return i >= 0 && j >= 0 && i + 1 < n && j + 1 < n &&
           std::hypot(place(i + 0.5), place(j + 0.5)) <= radius;
  };
  Disc disc;
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
  const Disc disc = disc_of(p);
  Draft draft = cloth_draft(disc.mesh, disc.held, p);
  inextensible::Positions& x = draft.scene.start.x;
  for (Eigen::Index v = 0; v < x.cols(); ++v) x(1, v) = unevenness(p, x(0, v), x(2, v));
  draft.scene.size = 2 * p.at("radius");
  return finished(std::move(draft));
}

std::pair<int, int> count_disc(const SceneParameters& p) {
  const Disc disc = disc_of(p);
  return count_cloth(disc.mesh, disc.held);
}

}  // namespace

SceneType cusick_scene() {
  const Fabric& cotton = fabric("cotton");
  return {
      "cusick",
      "a disc of cloth hangs over the edge of a round table (Cusick's drape test)",
      "n",
      {{"n", 31, "vertices along the disc's diameter", 7, 1000, true},
       {"radius", 0.15, "of the disc, m", 0, 1e6},
       {"table", 0.09, "radius on which it is held, m", 0, 1e6},
       {"density", cotton.density, "kg/m^2; here and below of cotton broadcloth", 0, 1e4},
       {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
       {"shear", fabric_shear, "shear stiffness, N/m; 0: none", -1e-300, 1e9},
       {"bending", cotton.bending, "bending rigidity of warp and weft, N m; 0: none", -1e-300, 1e6},
       {"drag", 1, "of still air, N s/m^3: force per area and speed; 0: none", -1e-300, 1e6},
       {"uneven", 2e-4, "height of waves along the rim at the start, m", -1e-300, 1e-2},
       {"duration", 1.5, "s", 0, 1e4}},
      build_cusick,
      count_disc,
      nullptr,
      "patch"};
}

}  // namespace harness
