#include "harness/scenes/disc_scenes.h"

#include <cmath>
#include <map>
#include <stdexcept>

#include "harness/scenes/fabrics.h"
#include "harness/scenes/meshes.h"

namespace harness {
namespace {

using inextensible::Edge;

// The quads of a square grid whose middle lies in the disc: its area is the disc's, but for what
// the grid leaves open.
class DiscGrid {
 public:
  explicit DiscGrid(const SceneParameters& p)
      : n_(static_cast<int>(p.at("n"))),
        link_(2 * p.at("radius") / (n_ - 1)),
        radius_(p.at("radius")),
        table_(p.at("table")) {
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j)
        if (quad(i, j) || quad(i - 1, j) || quad(i, j - 1) || quad(i - 1, j - 1))
          number_.try_emplace({i, j}, static_cast<int>(number_.size()));
    }
  }

  double link() const { return link_; }
  int vertices() const { return static_cast<int>(number_.size()); }
  // Of row i and column j; -1: none.
  int vertex(int i, int j) const {
    const auto found = number_.find({i, j});
    return found == number_.end() ? -1 : found->second;
  }
  // Whether vertices (i, j), (i, j + 1), (i + 1, j), (i + 1, j + 1) are a quad.
  bool quad(int i, int j) const {
    return i >= 0 && j >= 0 && i + 1 < n_ && j + 1 < n_ &&
           std::hypot(place(i + 0.5), place(j + 0.5)) <= radius_;
  }
  double place(double index) const { return link_ * (index - 0.5 * (n_ - 1)); }
  bool on_table(int i, int j) const { return std::hypot(place(i), place(j)) <= table_; }

  template <class Visit>
  void each_vertex(const Visit& visit) const {
    for (const auto& [at, v] : number_) visit(at.first, at.second, v);
  }
  // Sides of quads of which an end may move.
  template <class Visit>
  void each_edge(const Visit& visit) const {
    each_vertex([&](int i, int j, int v) {
      if ((quad(i, j) || quad(i - 1, j)) && !(on_table(i, j) && on_table(i, j + 1)))
        visit(v, vertex(i, j + 1));
      if ((quad(i, j) || quad(i, j - 1)) && !(on_table(i, j) && on_table(i + 1, j)))
        visit(v, vertex(i + 1, j));
    });
  }

 private:
  int n_;
  double link_, radius_, table_;
  std::map<std::pair<int, int>, int> number_;  // in the order of rows
};

// Height at the start, m: a few waves of unlike length, so that no symmetry holds folds back.
double unevenness(const SceneParameters& p, double x, double z) {
  const double r = std::hypot(x, z), table = p.at("table"), angle = std::atan2(z, x);
  const double out = std::max(0.0, (r - table) / (p.at("radius") - table));
  return p.at("uneven") * out * out *
         (std::cos(3 * angle + 0.4) + std::cos(5 * angle + 1.9) + std::cos(7 * angle + 0.9));
}

void bend(Draft& cloth, const DiscGrid& grid, const SceneParameters& p) {
  const double rigidity = p.at("bending") * grid.link();  // of a thread
  const auto thread = [&](std::array<std::pair<int, int>, 3> at) {
    std::array<int, 3> v{};
    bool moves = false;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = grid.vertex(at[k].first, at[k].second);
      if (v[k] < 0) return;
      moves = moves || !grid.on_table(at[k].first, at[k].second);
    }
    if (moves)
      cloth.parts.bending.push_back(
          inextensible::thread_bending(v[0], v[1], v[2], grid.link(), grid.link(), rigidity));
  };
  grid.each_vertex([&](int i, int j, int /*v*/) {
    thread({{{i, j}, {i, j + 1}, {i, j + 2}}});
    thread({{{i, j}, {i + 1, j}, {i + 2, j}}});
  });
}

// On each diagonal of a quad a spring whose stiffness is the cloth's shear stiffness, as in
// fabric_drape.
void shear(Draft& cloth, const DiscGrid& grid, const SceneParameters& p) {
  inextensible::Springs springs;
  grid.each_vertex([&](int i, int j, int v) {
    if (!grid.quad(i, j)) return;
    const int right = grid.vertex(i, j + 1), below = grid.vertex(i + 1, j),
              across = grid.vertex(i + 1, j + 1);
    cloth.scene.triangles.push_back({v, right, below});
    cloth.scene.triangles.push_back({across, right, below});
    if (!(grid.on_table(i, j) && grid.on_table(i + 1, j + 1))) springs.edges.push_back({v, across});
    if (!(grid.on_table(i, j + 1) && grid.on_table(i + 1, j)))
      springs.edges.push_back({right, below});
  });
  if (!(p.at("shear") > 0)) return;
  springs.rest_length.assign(springs.edges.size(), std::sqrt(2.0) * grid.link());
  springs.stiffness.assign(springs.edges.size(), p.at("shear"));
  cloth.parts.shear = std::move(springs);
}

Scene build_cusick(const SceneParameters& p) {
  if (!(p.at("table") < p.at("radius")))
    throw std::invalid_argument("a table of " + std::to_string(p.at("table")) +
                                " m under a disc of " + std::to_string(p.at("radius")) +
                                " m: nothing hangs over");
  const DiscGrid grid(p);
  Draft cloth;
  inextensible::ProblemParts& parts = cloth.parts;
  const double tile = grid.link() * grid.link();
  parts.mass.assign(grid.vertices(), 0);
  cloth.scene.start.x.resize(3, grid.vertices());
  cloth.scene.start.v.setZero(3, grid.vertices());
  grid.each_vertex([&](int i, int j, int v) {
    const double x = grid.place(j), z = grid.place(i);
    cloth.scene.start.x.col(v) << x, unevenness(p, x, z), z;
    if (grid.on_table(i, j)) parts.pinned.push_back(v);
    int quads = 0;
    for (const int a : {i - 1, i})
      for (const int b : {j - 1, j}) quads += grid.quad(a, b);
    parts.mass[v] = p.at("density") * tile * quads / 4;
    if (p.at("drag") > 0) parts.drag.push_back(p.at("drag") * tile * quads / 4);
  });
  grid.each_edge([&](int a, int b) { parts.edges.push_back({a, b}); });
  parts.rest_length.assign(parts.edges.size(), grid.link());
  parts.gravity = {0, -p.at("gravity"), 0};
  shear(cloth, grid, p);
  if (p.at("bending") > 0) bend(cloth, grid, p);
  parts.implicit_forces = true;
  cloth.scene.staggered = false;  // its rest is compared, and not the way there
  cloth.scene.duration = p.at("duration");
  cloth.scene.size = 2 * p.at("radius");
  return finished(std::move(cloth));
}

std::pair<int, int> count_disc(const SceneParameters& p) {
  const DiscGrid grid(p);
  int edges = 0;
  grid.each_edge([&](int /*a*/, int /*b*/) { ++edges; });
  return {grid.vertices(), edges};
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
