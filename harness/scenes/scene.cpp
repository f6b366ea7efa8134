#include "harness/scenes/scene.h"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "inextensible/problem/triangle_collider.h"

namespace harness {
namespace {

using inextensible::Problem;
using inextensible::ProblemParts;

std::size_t as_size(double value) { return static_cast<std::size_t>(value); }

// n vertices on a straight horizontal line, vertex 0 pinned, at rest, released.
Scene build_chain(const SceneParameters& p) {
  const int n = static_cast<int>(p.at("n"));
  const double length = p.at("length"), link = length / (n - 1);
  ProblemParts parts;
  parts.mass.assign(as_size(n), p.at("mass") / n);
  parts.pinned = {0};
  parts.gravity = {0, -p.at("gravity"), 0};
  Scene scene;
  scene.start.x.setZero(3, n);
  scene.start.v.setZero(3, n);
  Scene::Mirror plane{{0, 0, 1}, {}};
  for (int i = 0; i < n; ++i) {
    scene.start.x(0, i) = length * i / (n - 1);
    plane.image.push_back(i);
    if (i > 0) {
      parts.edges.push_back({i - 1, i});
      parts.rest_length.push_back(link);
    }
  }
  scene.problem = std::make_shared<const Problem>(std::move(parts));
  scene.duration = p.at("duration");
  scene.size = length;
  scene.mirrors.push_back(std::move(plane));
  scene.conserves_energy = true;
  return scene;
}

// n vertices on a straight horizontal line, both ends pinned `stretch` times its length apart.
Scene build_taut_row(const SceneParameters& p) {
  const int n = static_cast<int>(p.at("n"));
  const double length = p.at("length"), span = length * p.at("stretch");
  ProblemParts parts;
  parts.mass.assign(as_size(n), p.at("mass") / n);
  parts.pinned = {0, n - 1};
  parts.gravity = {0, -p.at("gravity"), 0};
  Scene scene;
  scene.start.x.setZero(3, n);
  scene.start.v.setZero(3, n);
  Scene::Mirror plane{{0, 0, 1}, {}}, left_right{{1, 0, 0}, {}};
  for (int i = 0; i < n; ++i) {
    scene.start.x(0, i) = 0.5 * span * (2 * i - (n - 1)) / (n - 1);
    plane.image.push_back(i);
    left_right.image.push_back(n - 1 - i);
    if (i > 0) {
      parts.edges.push_back({i - 1, i});
      parts.rest_length.push_back(length / (n - 1));
    }
  }
  scene.problem = std::make_shared<const Problem>(std::move(parts));
  scene.duration = p.at("duration");
  scene.size = length;
  scene.mirrors = {std::move(plane), std::move(left_right)};
  scene.conserves_energy = true;
  return scene;
}

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

// What drape and patch share: n x n vertices, flat and horizontal at height y, centred over the
// origin, or in waves, `folds` steep, the lowest point there; warp and weft constrained, shear
// springs where `shear` is positive. Not yet a problem.
struct Cloth {
  ProblemParts parts;
  Scene scene;
};

Cloth make_cloth(const SceneParameters& p, double y) {
  const int n = static_cast<int>(p.at("n"));
  const double side = p.at("side"), l = side / (n - 1);
  Cloth cloth;
  ProblemParts& parts = cloth.parts;
  Scene& scene = cloth.scene;
  parts.mass.assign(as_size(n) * as_size(n), p.at("mass") / (n * n));
  parts.gravity = {0, -p.at("gravity"), 0};
  scene.start.x.resize(3, n * n);
  scene.start.v.setZero(3, n * n);
  Scene::Mirror left_right{{1, 0, 0}, {}}, front_back{{0, 0, 1}, {}};
  // A sum of two curves keeps the length of every link: a Chebyshev net.
  const double folds = p.contains("folds") ? p.at("folds") : 0;
  const Eigen::Matrix2Xd wave = waves(n, l, folds);
  const auto vertex = [n](int i, int j) { return i * n + j; };  // row i along z, column j along x
  const auto constrain = [&](int a, int b) {
    parts.edges.push_back({a, b});
    parts.rest_length.push_back(l);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      // (2 j - (n - 1)) is exactly antisymmetric, so that the start is mirror symmetric to the last
      // bit.
      scene.start.x.col(vertex(i, j)) << 0.5 * l * (2 * j - (n - 1)), y,
          0.5 * l * (2 * i - (n - 1));
      left_right.image.push_back(vertex(i, n - 1 - j));
      front_back.image.push_back(vertex(n - 1 - i, j));
      if (folds > 0)
        scene.start.x.col(vertex(i, j)) << wave(0, j), y + wave(1, j) + wave(1, i), wave(0, i);
      if (j + 1 < n) constrain(vertex(i, j), vertex(i, j + 1));  // weft
      if (i + 1 < n) constrain(vertex(i, j), vertex(i + 1, j));  // warp
    }
  }
  if (p.at("shear") > 0) {
    inextensible::Springs shear;
    for (int i = 0; i + 1 < n; ++i) {
      for (int j = 0; j + 1 < n; ++j) {
        shear.edges.push_back({vertex(i, j), vertex(i + 1, j + 1)});
        shear.edges.push_back({vertex(i, j + 1), vertex(i + 1, j)});
      }
    }
    shear.rest_length.assign(shear.edges.size(), std::sqrt(2.0) * l);
    shear.stiffness.assign(shear.edges.size(), p.at("shear"));
    parts.shear = std::move(shear);
  }
  scene.duration = p.at("duration");
  scene.size = side;
  scene.mirrors = {std::move(left_right), std::move(front_back)};
  scene.corners = {vertex(0, 0), vertex(0, n - 1), vertex(n - 1, 0), vertex(n - 1, n - 1)};
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      scene.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j)});
      scene.triangles.push_back({vertex(i + 1, j + 1), vertex(i, j + 1), vertex(i + 1, j)});
    }
  }
  return cloth;
}

// Above a polygonal sphere that is centred at the origin.
Scene build_drape(const SceneParameters& p) {
  Cloth cloth = make_cloth(p, p.at("radius") + p.at("gap"));
  if (p.contains("speed")) cloth.scene.start.v.row(1).setConstant(-p.at("speed"));
  if (p.at("radius") > 0) {
    cloth.parts.collider = std::make_shared<const inextensible::TriangleCollider>(
        inextensible::icosphere(Eigen::Vector3d::Zero(), p.at("radius"),
                                static_cast<int>(p.at("subdivisions"))),
        p.at("friction"));
  }
  cloth.scene.problem = std::make_shared<const Problem>(std::move(cloth.parts));
  return std::move(cloth.scene);
}

// Pinned at two corners of one edge, which is straight at full length between them.
Scene build_patch(const SceneParameters& p) {
  Cloth cloth = make_cloth(p, 0);
  cloth.parts.pinned = {cloth.scene.corners[0], cloth.scene.corners[1]};
  cloth.scene.problem = std::make_shared<const Problem>(std::move(cloth.parts));
  cloth.scene.mirrors.pop_back();  // the pins break front to back
  cloth.scene.conserves_energy = true;
  return std::move(cloth.scene);
}

std::pair<int, int> count_cloth(const SceneParameters& p) {
  const int n = static_cast<int>(p.at("n"));
  return {n * n, 2 * n * (n - 1)};
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
          {"friction", 0.3, "Coulomb coefficient", -1e-300, 1e3}};
}

ParameterInfos joined(std::initializer_list<ParameterInfos> parts) {
  ParameterInfos all;
  for (const ParameterInfos& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

const std::vector<SceneType>& table() {
  static const std::vector<SceneType> rows = {
      {"chain",
       "a straight horizontal chain, pinned at one end, released",
       "n",
       {{"n", 80, "vertices", 2, 10'000'000, true},
        {"length", 1, "m", 0, 1e6},
        {"mass", 1, "total, kg", 0, 1e6},
        {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
        {"duration", 1, "s", 0, 1e4}},
       build_chain,
       [](const SceneParameters& p) {
         const int n = static_cast<int>(p.at("n"));
         return std::pair(n, n - 1);
       }},
      {"drape", "a square of cloth that falls onto a polygonal sphere", "n",
       joined({cloth_parameters(71), sphere_parameters(), {{"duration", 1, "s", 0, 1e4}}}),
       build_drape, count_cloth},
      {"folded_drape",
       "the drape, from a start in folds that shear it: as hard as mid-fall, at any size", "n",
       joined({cloth_parameters(71),
               {{"folds", 0.8, "slope of three waves each way, rad; 0: flat", -1e-300, 1.2},
                {"speed", 0, "downwards, at the start, m/s", -1e4, 1e4}},
               sphere_parameters(),
               {{"duration", 0.02, "s", 0, 1e4}}}),
       build_drape, count_cloth},
      {"patch", "a square of cloth, pinned at two corners of one edge, swings down (Figure 1)", "n",
       joined({cloth_parameters(31), {{"duration", 1, "s", 0, 1e4}}}), build_patch, count_cloth},
      {"taut_row",
       "a straight chain between two pins at its full length: J W J^T is singular",
       "n",
       {{"n", 31, "vertices", 3, 10'000'000, true},
        {"length", 1, "m", 0, 1e6},
        {"stretch", 1, "distance of the pins over the length; above 1: infeasible", 0, 100},
        {"mass", 1, "total, kg", 0, 1e6},
        {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
        {"duration", 1, "s", 0, 1e4}},
       build_taut_row,
       [](const SceneParameters& p) {
         const int n = static_cast<int>(p.at("n"));
         return std::pair(n, n - 1);
       }},
  };
  return rows;
}

}  // namespace

std::span<const SceneType> scene_types() { return table(); }

const SceneType* find_scene(std::string_view name) {
  for (const SceneType& type : table()) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

SceneParameters complete_parameters(const SceneType& type, const SceneParameters& given) {
  SceneParameters all;
  std::vector<std::string> names;
  for (const auto& info : type.parameters) {
    all[info.name] = info.initial;
    names.emplace_back(info.name);
  }
  for (const auto& [name, value] : given) {
    if (!all.contains(name))
      throw unknown_name("parameter of scene " + std::string(type.name), name, names);
    all[name] = value;
  }
  for (const auto& info : type.parameters) {
    const double value = all[info.name];
    const bool inside = (info.integer ? value >= info.low : value > info.low) && value <= info.high;
    if (inside && (!info.integer || value == std::floor(value))) continue;
    const std::string bound = info.integer ? "a whole number of at least " + number_text(info.low)
                              : info.low == -1e-300 ? "at least 0"
                                                    : "above " + number_text(info.low);
    throw UsageError("scene " + std::string(type.name) + ": '" + info.name + "' is " +
                     number_text(value) + ", must be " + bound + " and at most " +
                     number_text(info.high));
  }
  return all;
}

}  // namespace harness
