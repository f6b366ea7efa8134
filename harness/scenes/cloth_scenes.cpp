// Scenes of a square of cloth.
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "harness/scenes/fabrics.h"
#include "harness/scenes/meshes.h"
#include "harness/scenes/rows.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

// One of the two curves whose sum is a folded cloth: n points, links of length l, in waves of the
// slope A sin(2 pi w s) over the arc length s, mirrored about its middle to the last bit. Columns:
// (along, up), the lowest at up = 0.
Eigen::Matrix2Xd waves(int n, double l, double slope) {
  constexpr double count = 3;
  Eigen::Matrix2Xd p(2, n);
  const auto link = [&](double from_middle) -> Eigen::Vector2d {  // in links
    const double angle = slope * std::sin(2 * std::numbers::pi * count * from_middle / (n - 1));
    return {l * std::cos(angle), l * std::sin(angle)};
  };
  const int right = n / 2;  // the middle vertex, or the first one right of the middle link
  p.col(right) = n % 2 == 1 ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(0.5 * l, 0);
  for (int j = right + 1; j < n; ++j) p.col(j) = p.col(j - 1) + link(j - 0.5 - 0.5 * (n - 1));
  for (int j = 0; j < n / 2; ++j) p.col(j) << -p(0, n - 1 - j), p(1, n - 1 - j);
  p.row(1).array() -= p.row(1).minCoeff();
  return p;
}

// In waves, `folds` steep, the lowest point at the height y. A sum of two curves keeps the length
// of every link: a Chebyshev net.
void fold(Scene& scene, const SceneParameters& p, double y) {
  const int n = static_cast<int>(p.at("n"));
  const Eigen::Matrix2Xd wave = waves(n, square_link(p), p.at("folds"));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      scene.start.x.col(i * n + j) << wave(0, j), y + wave(1, j) + wave(1, i), wave(0, i);
  }
}

// A polygonal sphere, centred at the origin, if it has a radius.
void add_ball(Draft& cloth, const SceneParameters& p) {
  if (!(p.at("radius") > 0)) return;
  cloth.parts.collider = std::make_shared<const inextensible::TriangleCollider>(
      inextensible::icosphere(Eigen::Vector3d::Zero(), p.at("radius"),
                              static_cast<int>(p.at("subdivisions"))),
      p.at("friction"));
  cloth.parts.contact_inside = p.at("contact") != 0;
}

// Above the ball.
Scene build_drape(const SceneParameters& p) {
  const double y = p.at("radius") + p.at("gap");
  Draft cloth = vertex_square(p, y);
  if (p.contains("folds") && p.at("folds") > 0) fold(cloth.scene, p, y);
  cloth.parts.implicit_forces = p.contains("implicit") && p.at("implicit") != 0;
  if (p.contains("speed")) cloth.scene.start.v.row(1).setConstant(-p.at("speed"));
  add_ball(cloth, p);
  return finished(std::move(cloth));
}

// With a fabric's own forces, in physical units, at the end of the step. Each diagonal of a quad,
// as a spring of stiffness G, gives the cloth the shear stiffness G: turned by gamma they change by
// l gamma / sqrt(2) each, and bear G (l gamma)^2 / 2 together.
Scene build_fabric_drape(const SceneParameters& given) {
  SceneParameters p = given;
  p["mass"] = p.at("density") * p.at("side") * p.at("side");
  const double y = p.at("radius") + p.at("gap");
  Draft cloth = vertex_square(p, y);
  if (p.at("bending") > 0) bend_yarns(cloth, p, p.at("bending"));
  if (p.at("drag") > 0) {
    const double l = square_link(p);
    cloth.parts.drag.assign(cloth.parts.mass.size(), p.at("drag") * l * l);
  }
  cloth.parts.implicit_forces = true;
  add_ball(cloth, p);
  return finished(std::move(cloth));
}

// For speed at sizes at which the start's acceleration would take longer to find than a step, and a
// few steps only, whose path is compared with nothing.
Scene build_folded_drape(const SceneParameters& p) {
  Scene scene = build_drape(p);
  scene.staggered = false;
  return scene;
}

// Pinned at two corners of one edge, which is straight at full length between them.
Scene build_patch(const SceneParameters& p) {
  Draft cloth = vertex_square(p, 0);
  cloth.parts.pinned = {cloth.scene.corners[0], cloth.scene.corners[1]};
  cloth.scene.mirrors.pop_back();  // the pins break front to back
  cloth.scene.conserves_energy = true;
  return finished(std::move(cloth));
}

// Below its pins, turned by `tilt` out of the vertical so that it may fold, in air that brings it
// to rest.
Scene build_hung_patch(const SceneParameters& p) {
  Draft cloth = vertex_square(p, 0);
  Scene& scene = cloth.scene;
  const double side = p.at("side"), tilt = p.at("tilt"), l = square_link(p);
  for (Eigen::Index v = 0; v < scene.start.x.cols(); ++v) {
    auto x = scene.start.x.col(v);
    const double below = x.z() + 0.5 * side;
    x << x.x(), -below * std::cos(tilt), below * std::sin(tilt);
  }
  cloth.parts.pinned = {scene.corners[0], scene.corners[1]};
  if (p.at("drag") > 0) cloth.parts.drag.assign(cloth.parts.mass.size(), p.at("drag") * l * l);
  const int n = static_cast<int>(p.at("n"));
  scene.marks = {{"top_row", n / 2, 0}, {"lower_edge", (n - 1) * n + n / 2, -side}};
  scene.mirrors.pop_back();
  scene.staggered = false;  // its rest is compared, and not the way there
  return finished(std::move(cloth));
}

using ParameterInfos = std::vector<SceneParameterInfo>;

ParameterInfos cloth_parameters(int n) {
  return {
      {"n", static_cast<double>(n), "vertices along each side", 2, 4000, true},
      {"side", 1, "m", 0, 1e6},
      {"mass", 0.2, "total, kg", 0, 1e6},
      {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
      {"shear", 0.1, "spring stiffness on both diagonals of each quad, N/m; 0: no springs at all",
       -1e-300, 1e9}};
}

ParameterInfos sphere_parameters() {
  return {{"radius", 0.25, "of the sphere, m; 0: no collider at all", -1e-300, 1e6},
          {"subdivisions", 3, "of the icosahedron; 3: 1,280 triangles", 0, 6, true},
          {"gap", 0.001, "between sphere and cloth at the start, m", -1e-300, 1e6},
          {"friction", 0.3, "Coulomb coefficient", -1e-300, 1e3},
          {"contact", 1,
           "1: enforced together with edges; 0: in a pass of its own after that, as in the paper",
           -1e-300, 1, true}};
}

ParameterInfos joined(std::initializer_list<ParameterInfos> parts) {
  ParameterInfos all;
  for (const ParameterInfos& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// density in kg/m^2, bending in N m, shear in N/m.
SceneType fabric_on_ball(const char* name, const char* summary, double density, double bending,
                         double shear) {
  return {name,
          summary,
          "n",
          joined({{{"n", 71, "vertices along each side", 3, 4000, true},
                   {"side", 1, "m", 0, 1e6},
                   {"density", density, "kg/m^2", 0, 1e4},
                   {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
                   {"shear", shear, "shear stiffness, N/m; 0: none", -1e-300, 1e9},
                   {"bending", bending, "bending rigidity of warp and weft, N m; 0: none", -1e-300,
                    1e6},
                   {"drag", 0.05, "of still air, N s/m^3: force per area and speed; 0: none",
                    -1e-300, 1e6}},
                  sphere_parameters(),
                  {{"duration", 1, "s", 0, 1e4}}}),
          build_fabric_drape,
          count_square,
          nullptr,
          "drape"};
}

SceneType preset(const char* name, const char* summary, const Fabric& cloth) {
  return fabric_on_ball(name, summary, cloth.density, cloth.bending, fabric_shear);
}

}  // namespace

SceneType drape_scene() {
  return {"drape",
          "a square of cloth that falls onto a polygonal sphere",
          "n",
          joined({cloth_parameters(71),
                  {{"implicit", 0, "shear as it is at the end of a step: 1; at its start: 0",
                    -1e-300, 1, true}},
                  sphere_parameters(),
                  {{"duration", 1, "s", 0, 1e4}}}),
          build_drape,
          count_square};
}

SceneType fabric_drape_scene() {
  return fabric_on_ball(
      "fabric_drape",
      "the drape with a fabric's weight, shear and bending in physical units, implicit, and air",
      0.15, 1e-5, 20);
}

SceneType cotton_drape_scene() {
  return preset("cotton_drape", "fabric_drape of cotton broadcloth, as measured", fabric("cotton"));
}

SceneType wool_drape_scene() {
  return preset("wool_drape", "fabric_drape of wool tropical, as measured", fabric("wool"));
}

SceneType polyester_drape_scene() {
  return preset("polyester_drape", "fabric_drape of polyester tropical, as measured",
                fabric("polyester"));
}

SceneType folded_drape_scene() {
  return {"folded_drape",
          "the drape, from a start in folds that shear it: as hard as mid-fall, at any size",
          "n",
          joined({cloth_parameters(71),
                  {{"folds", 0.8, "slope of three waves each way, rad; 0: flat", -1e-300, 1.2},
                   {"speed", 0, "downwards, at the start, m/s", -1e4, 1e4}},
                  sphere_parameters(),
                  {{"duration", 0.02, "s", 0, 1e4}}}),
          build_folded_drape,
          count_square,
          nullptr,
          "drape"};
}

SceneType hung_patch_scene() {
  return {"hung_patch",
          "the patch as it hangs from two corners, brought to rest by air (Figure 1)",
          "n",
          joined({cloth_parameters(31),
                  {{"tilt", 0.3, "out of the vertical, at the start, rad", -1.5, 1.5},
                   {"drag", 2, "of still air, N s/m^3: force per area and speed; 0: none", -1e-300,
                    1e6},
                   {"duration", 3, "s", 0, 1e4}}}),
          build_hung_patch,
          count_square,
          nullptr,
          "patch"};
}

SceneType patch_scene() {
  return {
      "patch",     "a square of cloth, pinned at two corners of one edge, swings down (Figure 1)",
      "n",         joined({cloth_parameters(31), {{"duration", 1, "s", 0, 1e4}}}),
      build_patch, count_square};
}

}  // namespace harness
