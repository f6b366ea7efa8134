// Scenes of a square of cloth, and of a disc.
#include <cmath>

#include "harness/scenes/cloth_mesh.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

// Matsudaira, Masuda, Wada and Yokura 2015, "Shape Factor of Flared Skirts Compared with That of
// Circular Fabrics", Journal of Textile Engineering 61(6), tables 1 and 2: Kawabata's instruments,
// means of warp and weft; mg/cm^2 and gf cm^2/cm. Their cotton is a broadcloth.
constexpr double mg_cm2 = 1e-6 / (1e-2 * 1e-2);                // kg/m^2
constexpr double gf_cm2_cm = 9.80665e-3 * 1e-2 * 1e-2 / 1e-2;  // N m
// Shear stiffness in N/m that is assumed for all: 1 gf/(cm degree), the usual order of magnitude of
// apparel fabrics on Kawabata's shear tester.
constexpr double fabric_shear = 9.80665e-3 / 1e-2 * 180 / std::numbers::pi;

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

// A sum of two curves, which keeps the length of every link: a Chebyshev net. The lowest point is
// at the height y, the middle `aside` off the axis along x, and half as far along -z.
void lay(Scene& scene, const Eigen::Matrix2Xd& weft, const Eigen::Matrix2Xd& warp, double y,
         double aside = 0) {
  const Eigen::Index n = weft.cols();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      scene.start.x.col(i * n + j) << weft(0, j) + aside, y + weft(1, j) + warp(1, i),
          warp(0, i) - 0.5 * aside;
}

// Off the ball's axis and in two unlike waves, so that no symmetry is left. Along each side the
// slope is A sin(2 pi w s + phase), whose height is `waves` m either way; the lowest vertex is at
// y.
void place_unevenly(Scene& scene, const SceneParameters& p, double y) {
  const int n = whole(p);
  const double l = square_link(p), side = p.at("side");
  const auto curve = [&](double count, double phase) {
    const double slope = 2 * std::numbers::pi * count * p.at("waves") / side;
    Eigen::Matrix2Xd at(2, n);  // along, up
    at.col(0).setZero();
    for (int j = 1; j < n; ++j) {
      const double s = (j - 0.5) / (n - 1);
      const double angle = slope * std::sin(2 * std::numbers::pi * count * s + phase);
      at.col(j) = at.col(j - 1) + l * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    at.row(0).array() -= at.row(0).mean();
    at.row(1).array() -= at.row(1).minCoeff();
    return at;
  };
  lay(scene, curve(2, 0.7), curve(1.5, 2.1), y, value_or_zero(p, "off_axis"));
}

// Above a polygonal sphere, centred at the origin, if that has a radius.
Scene build_drape(const SceneParameters& p) {
  const double y = p.at("radius") + p.at("gap");
  Draft cloth = vertex_square(p, y);
  if (p.contains("waves")) place_unevenly(cloth.scene, p, y);
  if (p.contains("folds")) {
    const Eigen::Matrix2Xd wave = waves(whole(p), square_link(p), p.at("folds"));
    if (p.at("folds") > 0) lay(cloth.scene, wave, wave, y);
    cloth.scene.start.v.row(1).setConstant(-p.at("speed"));
    // For speed at sizes at which the start's acceleration would take longer to find than a step,
    // and a few steps only, whose path is compared with nothing.
    cloth.scene.staggered = false;
  }
  if (value_or_zero(p, "implicit") != 0) cloth.parts.implicit_forces = true;
  if (p.at("radius") > 0) {
    cloth.parts.collider = std::make_shared<const inextensible::TriangleCollider>(
        inextensible::icosphere(Eigen::Vector3d::Zero(), p.at("radius"), whole(p, "subdivisions")),
        p.at("friction"));
    cloth.parts.contact_inside = p.at("contact") != 0;
  }
  return finished(std::move(cloth));
}

// Pinned at two corners of one edge, which is straight at full length between them.
Scene build_patch(const SceneParameters& p) {
  Draft cloth = vertex_square(p, 0);
  return released(std::move(cloth), {0, whole(p) - 1});
}

constexpr double above_the_table = 1e-6;  // m, as nothing may start in an obstacle

// A fabric in air that swings down from two corners, in waves.
Scene build_curtain(const SceneParameters& p) {
  Draft cloth = vertex_square(p, 0);
  place_unevenly(cloth.scene, p, 0);
  cloth.parts.pinned = {0, whole(p) - 1};
  return finished(std::move(cloth));
}

// Slides along x on the top of a flat box, which is wider than the way to its rest.
Scene build_block(const SceneParameters& p) {
  Draft cloth = vertex_square(p, above_the_table);
  cloth.scene.start.v.row(0).setConstant(p.at("speed"));
  const double way = p.at("speed") * p.at("speed") / (2 * p.at("friction") * p.at("gravity"));
  const double wide = p.at("side") + 2 * way, deep = p.at("side");
  inextensible::TriangleMesh box;
  add_block(box, {-wide, -deep, -wide}, {wide, 0, wide});
  cloth.parts.collider =
      std::make_shared<const inextensible::TriangleCollider>(std::move(box), p.at("friction"));
  return finished(std::move(cloth));
}

// Coulomb friction slows it by mu g until it stops.
Positions block_at(const SceneParameters& p, double time) {
  const double slowing = p.at("friction") * p.at("gravity"),
               sliding = std::min(time, p.at("speed") / slowing);
  Positions x = vertex_square(p, above_the_table).scene.start.x;
  x.row(0).array() += sliding * (p.at("speed") - 0.5 * slowing * sliding);
  return x;
}

// Below its pins, turned by `tilt` out of the vertical so that it may fold, in air that brings it
// to rest.
Scene build_hung_patch(const SceneParameters& p) {
  Draft cloth = vertex_square(p, 0);
  Scene& scene = cloth.scene;
  const double side = p.at("side"), tilt = p.at("tilt");
  for (Eigen::Index v = 0; v < scene.start.x.cols(); ++v) {
    auto x = scene.start.x.col(v);
    const double below = x.z() + 0.5 * side;
    x << x.x(), -below * std::cos(tilt), below * std::sin(tilt);
  }
  const int n = whole(p);
  cloth.parts.pinned = {0, n - 1};
  scene.marks = {{"top_row", n / 2, 0}, {"lower_edge", (n - 1) * n + n / 2, -side}};
  scene.staggered = false;  // its rest is compared, and not the way there
  return finished(std::move(cloth));
}

ParameterInfos cloth_parameters(int n) {
  return {
      {"n", static_cast<double>(n), "vertices along each side", 2, 4000, true},
      {"side", 1, "m", 0, 1e6},
      {"mass", 0.2, "total, kg", 0, 1e6},
      gravity_info(),
      {"shear", 0.1, "spring stiffness on both diagonals of each quad, N/m; 0: no springs at all",
       zero_too, 1e9}};
}

ParameterInfos drape_parameters(const ParameterInfos& cloth, const ParameterInfos& own,
                                double duration = 1) {
  return joined(
      {cloth,
       own,
       {{"radius", 0.25, "of the sphere, m; 0: no collider at all", zero_too, 1e6},
        {"subdivisions", 3, "of the icosahedron; 3: 1,280 triangles", 0, 6, true},
        {"gap", 0.001, "between sphere and cloth at the start, m", zero_too, 1e6},
        friction_info(0.3),
        {"contact", 1,
         "1: enforced together with edges; 0: in a pass of its own after that, as in the paper",
         zero_too, 1, true},
        duration_info(duration)}});
}

ParameterInfos fabric_square(double n, const ClothDefaults& fabric) {
  return joined({{{"n", n, "vertices along each side", 3, 4000, true}, {"side", 1, "m", 0, 1e6}},
                 fabric_parameters(fabric)});
}

// Stiff cotton in air, whose start has waves.
ParameterInfos stiff_cotton(double n) {
  return joined({fabric_square(n, {0.15, fabric_shear, 5e-4, 4}),
                 {{"waves", 0.01, "amplitude of the start's waves, m; 0: flat", zero_too, 0.05}}});
}

// ---- Cusick's drape test ----
// The quads of a square grid whose middle lies in the disc: its area is the disc's, but for what
// the grid leaves open. In the plane y = 0, pinned where the table is.
ClothMesh disc_of(const SceneParameters& p) {
  const auto n = whole(p);
  const double radius = p.at("radius"), link = 2 * radius / (n - 1);
  const auto place = [&](double index) { return link * (index - 0.5 * (n - 1)); };
  const auto quad = [&](int i, int j) {
    return i >= 0 && j >= 0 && i + 1 < n && j + 1 < n &&
           std::hypot(place(i + 0.5), place(j + 0.5)) <= radius;
  };
  ClothMesh disc;
  std::vector<int> number(n * n, -1);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (!quad(i, j) && !quad(i - 1, j) && !quad(i, j - 1) && !quad(i - 1, j - 1)) continue;
      number[i * n + j] = static_cast<int>(disc.vertices.size());
      disc.vertices.emplace_back(place(j), 0, place(i));
      disc.held.push_back(std::hypot(place(i), place(j)) <= p.at("table"));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int* at = number.data() + i * n + j;
      if (quad(i, j)) disc.quads.push_back({at[0], at[1], at[n + 1], at[n]});
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
  Positions& x = draft.scene.start.x;
  for (Eigen::Index v = 0; v < x.cols(); ++v) x(1, v) = unevenness(p, x(0, v), x(2, v));
  draft.scene.size = 2 * p.at("radius");
  return finished(std::move(draft));
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
std::vector<SceneType> cloth_scenes() {
  return {
      {.name = "drape",
       .summary = "a square of cloth that falls onto a polygonal sphere",
       .parameters = drape_parameters(
           cloth_parameters(71),
           {{"implicit", 0, "shear as it is at the end of a long step: 1; at its start: 0",
             zero_too, 1, true}}),
       .build = build_drape,
       .counts = count_square},
      {.name = "fabric_drape",
       .summary = "the drape with a fabric's weight, shear and bending in physical units, "
                  "implicit, and air",
       .parameters = drape_parameters(fabric_square(71, {0.15, 20, 1e-5, 0.05}), {}),
       .build = build_drape,
       .counts = count_square,
       .like = "drape"},
      // Known to its end: air and bending let it fold in one way only.
      {.name = "settling_drape",
       .summary = "stiff cotton that falls onto a sphere in air, off its axis, and comes to rest",
       .parameters = drape_parameters(
           stiff_cotton(71),
           {{"off_axis", 0.08,
             "how far its middle is from the sphere's axis along x, and half as far along -z, m",
             -10, 10}},
           3),
       .build = build_drape,
       .counts = count_square},
      {.name = "curtain",
       .summary = "stiff cotton that swings down in air from two corners",
       .parameters = joined({stiff_cotton(31), {duration_info()}}),
       .build = build_curtain,
       .counts = count_square,
       .like = "patch"},
      {.name = "sliding_block",
       .summary =
           "a square of cloth that slides on a table until friction stops it: its motion is known",
       .parameters = joined({cloth_parameters(5),
                             {{"speed", 1, "at the start, m/s", 0, 1e4},
                              {"friction", 0.3, "Coulomb coefficient", 0, 1e3},
                              duration_info(0.6)}}),
       .build = build_block,
       .counts = count_square,
       .exact = block_at,
       .like = "drape"},
      {.name = "folded_drape",
       .summary =
           "the drape, from a start in folds that shear it: as hard as mid-fall, at any size",
       .parameters = drape_parameters(
           cloth_parameters(71),
           {{"folds", 0.8, "slope of three waves each way, rad; 0: flat", zero_too, 1.2},
            {"speed", 0, "downwards, at the start, m/s", -1e4, 1e4}},
           0.02),
       .build = build_drape,
       .counts = count_square,
       .like = "drape"},
      {.name = "hung_patch",
       .summary = "the patch as it hangs from two corners, brought to rest by air (Figure 1)",
       .parameters = joined({cloth_parameters(31),
                             {{"tilt", 0.3, "out of the vertical, at the start, rad", -1.5, 1.5},
                              drag_info(2),
                              duration_info(3)}}),
       .build = build_hung_patch,
       .counts = count_square,
       .like = "patch"},
      {.name = "patch",
       .summary = "a square of cloth, pinned at two corners of one edge, swings down (Figure 1)",
       .parameters = joined({cloth_parameters(31), {duration_info()}}),
       .build = build_patch,
       .counts = count_square},
      {.name = "cusick",
       .summary =
           "a disc of cotton broadcloth hangs over the edge of a round table (Cusick's drape test)",
       .parameters = with_cloth_parameters(
           {{"n", 31, "vertices along the disc's diameter", 7, 1000, true},
            {"radius", 0.15, "of the disc, m", 0, 1e6},
            {"table", 0.09, "radius on which it is held, m", 0, 1e6},
            {"uneven", 2e-4, "height of waves along the rim at the start, m", zero_too, 1e-2}},
           {.density = 12.38 * mg_cm2,
            .shear = fabric_shear,
            .bending = 0.118 * gf_cm2_cm,
            .drag = 1},
           1.5),
       .build = build_cusick,
       .counts = [](const SceneParameters& p) { return count_cloth(disc_of(p)); },
       .like = "patch"}};
}

}  // namespace harness
