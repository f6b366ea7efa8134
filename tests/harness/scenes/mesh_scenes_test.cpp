// Cloth from files: the square of the built-in scenes, read back, must be that square, however its
// faces are cut; and what can be no cloth is refused in one line.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <regex>
#include <set>

#include "harness/base/text.h"
#include "harness/judge/mechanics.h"
#include "harness/scenes/mesh_file.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"
#include "support/refusal.h"
#include "support/scenes.h"

namespace harness {
namespace {

std::string file_with(const std::string& name, const std::string& text) {
  const std::string path = ::testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

// The name of a scene of such a file, by default pinned along its highest row.
std::string mesh(const std::string& text, const std::string& parts = ",pins=y>-0.01") {
  return "mesh:" + file_with("cloth.obj", text) + parts;
}

// A block, turned about the vertical.
std::string block_file(const std::string& name, const Eigen::Vector3d& low,
                       const Eigen::Vector3d& high, double turn = 0) {
  inextensible::TriangleMesh block;
  add_block(block, low, high);
  Positions x(3, 8);
  for (int v = 0; v < 8; ++v)
    x.col(v) = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()) * block.vertices[v];
  return file_with(name, obj_text(x, block.triangles, {}));
}

// The quad in two, by the diagonal from a or from b.
std::string halves(bool from_a, int a, int b, int c, int d) {
  return concat("f ", a, ' ', b, ' ', from_a ? c : d, "\nf ", from_a ? a : b, ' ', c, ' ', d, '\n');
}

// n x n vertices in the plane z = 0, 1 wide, the highest row at y = 0. cut: each quad in two.
std::string square(int n, const std::function<bool(int, int)>& cut = nullptr) {
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      text << "v " << static_cast<double>(j) / (n - 1) << ' ' << -static_cast<double>(i) / (n - 1)
           << " 0\n";
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j + 1, b = a + 1, c = a + n + 1, d = a + n;
      text << (cut ? halves(cut(i, j), a, b, c, d)
                   : concat("f ", a, "//1 ", b, "//1 ", c, "//1 ", d, "//1\n"));
    }
  return text.str();
}

// The places that edges join: the same whatever the numbers of vertices are.
using Place = std::array<long, 3>;
std::set<std::pair<Place, Place>> joined_places(const Scene& scene,
                                                const std::vector<inextensible::Edge>& edges) {
  const auto place = [&](int v) -> Place {
    const Eigen::Vector3d x = 1e6 * scene.start.x.col(v);
    return {std::lround(x.x()), std::lround(x.y()), std::lround(x.z())};
  };
  std::set<std::pair<Place, Place>> all;
  for (const auto& [a, b] : edges) all.insert(std::minmax(place(a), place(b)));
  return all;
}
auto joined_places(const Scene& scene) { return joined_places(scene, scene.problem->edges()); }

TEST(MeshScene, OfASquareIsThePatch) {
  const int n = 7;
  const auto type = find_scene(mesh(square(n), ",pins=y>-0.01andx<0.01"));
  const SceneParameters p = complete_parameters(*type, {{"density", 0.2}});
  const auto built = type->build(p).problem;
  const inextensible::Problem& problem = *built;
  EXPECT_EQ(problem.vertices(), n * n);
  EXPECT_EQ(problem.constraints(), 2 * n * (n - 1));
  EXPECT_EQ(problem.pinned().size(), 1);
  ASSERT_TRUE(problem.shear());
  EXPECT_EQ(problem.shear()->edges.size(), 2 * (n - 1) * (n - 1));
  EXPECT_NEAR(problem.total_mass(), 0.2, 1e-12);
  EXPECT_EQ(problem.bending().size(), 2 * n * (n - 2));
  for (const double l : problem.rest_length()) EXPECT_NEAR(l, 1.0 / (n - 1), 1e-12);
  EXPECT_EQ(type->counts(p), std::pair(n * n, 2 * n * (n - 1)));
}

TEST(MeshScene, OfTrianglesIsThatOfTheQuadsTheyMake) {
  std::mt19937_64 random(3);
  for (const auto& cut : {std::function<bool(int, int)>([](int, int) { return true; }),
                          std::function<bool(int, int)>([](int i, int j) { return (i + j) % 2; }),
                          std::function<bool(int, int)>([&](int, int) { return random() % 2; })}) {
    const Scene quads = built_scene(mesh(square(6))), triangles = built_scene(mesh(square(6, cut)));
    EXPECT_EQ(joined_places(quads), joined_places(triangles));
    EXPECT_EQ(joined_places(quads, quads.problem->shear()->edges),
              joined_places(triangles, triangles.problem->shear()->edges));
  }
}

TEST(MeshScene, CutFinerIsTheFinerSquare) {
  const Scene coarse = built_scene(mesh(square(4)), {{"n", 3}}),
              fine = built_scene(mesh(square(10)));
  EXPECT_EQ(joined_places(coarse), joined_places(fine));
  EXPECT_NEAR(coarse.problem->total_mass(), fine.problem->total_mass(), 1e-12);
  EXPECT_EQ(coarse.problem->bending().size(), fine.problem->bending().size());
}

// Three flat triangles around a vertex, beside a quad: no two of them make a good quad, so that
// springs hold them, and cut finer they stay of one piece.
TEST(MeshScene, TrianglesThatMakeNoQuadsHoldWithSprings) {
  std::ostringstream text;
  text << "v 0 0 0\n";
  for (int k = 0; k < 3; ++k)
    text << "v " << std::cos(2 * k * std::numbers::pi / 3) << " 0 "
         << std::sin(2 * k * std::numbers::pi / 3) << '\n';
  text << "v 2 0 0\nv 2 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 5 6 3\n";
  for (const int n : {1, 2, 5}) {
    const Scene scene = built_scene(mesh(text.str(), ",pins=v5"), {{"n", n}});
    const int vertices = 1 + 3 * n * (n + 1) / 2, triangles = 3 * n * n;
    EXPECT_EQ(scene.problem->vertices(), vertices + n * (n + 1));
    EXPECT_EQ(scene.triangles.size(), triangles + 2 * n * n);
    EXPECT_EQ(scene.problem->constraints(), 2 * n * (n + 1));
    ASSERT_TRUE(scene.problem->shear());
    const int sides = vertices + triangles - 1;  // Euler; n of them are the quad's
    EXPECT_EQ(scene.problem->shear()->edges.size(), sides - n + 2 * n * n);
  }
}

TEST(MeshScene, FallsOntoItsBodyAndKeepsItsLimit) {
  const std::string body = block_file("box.obj", {-1, -1.5, -1}, {2, -1, 1});
  // It hangs above, its lowest row on the box, and folds.
  const Scene scene = built_scene(mesh(square(8), ",body=" + body));
  const auto stepper = inextensible::make_stepper("fast_projection", scene.problem, {0.01});
  inextensible::State state = scene.start;
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(stepper->advance(state, 0.01));
  EXPECT_GE(state.x.row(1).minCoeff(), -1 - 1e-5);
  EXPECT_LT(state.x.row(1).minCoeff(), -0.99);
  EXPECT_LE(strain_range(*scene.problem, state.x).most, 0.01 + 1e-9);
}

TEST(MeshScene, IsWhatItsExporterMeans) {
  const std::string plain = square(3);
  std::string double_sided = plain, continued = plain, spare = plain;
  spare.insert(spare.find("f "), "v 9 9 9\n");  // so that no corner would be missing
  double_sided += "f 5 4 1 2\n";                // the first face from behind
  continued.insert(continued.find(" 2//1"), " \\\r\n");
  const Scene expected = built_scene(mesh(plain));
  for (const std::string& text :
       {"\xEF\xBB\xBF" + plain, "\xEF\xBB\xBF" + spare, plain + "vt 0 1\nusemtl cotton # blue\n",
        plain.substr(0, plain.size() - 1) + " # the last face\n", double_sided, continued,
        "v 9 9 9\n" + std::regex_replace(plain, std::regex("(\\d+)//1"), "-$1"),
        std::regex_replace(plain, std::regex("f 1//1 2//1 5//1 4//1"), "f 1 2 5\nf 1 5 4")})
    EXPECT_EQ(joined_places(built_scene(mesh(text))), joined_places(expected)) << text;
  EXPECT_NE(find_scene(mesh(double_sided))->remarks.find("twice: 1"), std::string::npos);
  const Scene fan = built_scene(
      mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 0 1 0\nf 2 3 4 5 6 1\n", ",pins=v1"));
  EXPECT_EQ(fan.triangles.size(), 4) << "a face of six corners";
}

TEST(MeshScene, PinsAreConditionsJoinedByAndAndOr) {
  const std::string name = mesh(square(5), ",pins=");
  for (const auto& [pins, count] :
       std::initializer_list<std::pair<const char*, int>>{{"y>-0.01", 5},
                                                          {"y>=0", 5},
                                                          {"y>0orx>=1", 5},
                                                          {"y>=0andx>=1", 1},
                                                          {"near(-3:2:0)ornear(3:2:0)", 2},
                                                          {"v1orv5ory<=-1", 7},
                                                          {"y>=0andx<0.1orv13", 2}}) {
    EXPECT_EQ(built_scene(name + pins).problem->pinned().size(), count) << pins;
    EXPECT_EQ(built_scene(name + pins, {{"n", 2}}).problem->pinned().size() > 2, count > 2);
  }
}

// Every face with corners of its own, as surfaces are exported for printing.
TEST(MeshScene, InPiecesIsRefusedUntilItIsWelded) {
  const std::string soup =
      "v 0 0 0\nv .5 0 0\nv .5 -.5 0\nv 0 -.5 0\nv .5 0 0\nv 1 0 0\nv 1 -.5 0\nv .5 -.5 1e-9\n"
      "v 0 -.5 0\nv .5 -.5 0\nv .5 -1 0\nv 0 -1 0\nv .5 -.5 0\nv 1 -.5 0\nv 1 -1 0\nv .5 -1 0\n"
      "f 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\nf 13 14 15 16\n";
  const std::string triangles =
      std::regex_replace(soup, std::regex("f (\\d+) (\\d+) (\\d+) (\\d+)"), "f $1 $2 $3");
  for (const std::string& text : {soup, triangles})
    for (const char* part :
         {"in 4 pieces, 2 of them pinned nowhere, as that of vertex 9", "--weld 1e-6"})
      EXPECT_TRUE(refuses([&] { find_scene(mesh(text, ",pins=y>=0")); }, part));
  EXPECT_EQ(joined_places(built_scene(mesh(square(3)))),
            joined_places(built_scene(mesh(soup, ",pins=y>=0,weld=1e-6"))));
}

TEST(MeshScene, BodiesAreTurnedWeldedAndOutsideTheCloth) {
  const std::string corners =
      "v -1 -3 -1\nv 2 -3 -1\nv 2 -3 1\nv -1 -3 1\nv -1 -2 -1\nv 2 -2 -1\nv 2 -2 1\nv -1 -2 1\n";
  const std::string sheet = mesh(square(4), ",body=");
  const auto top = [&](const std::string& text, const char* parts = "") {
    const Scene scene = built_scene(sheet + file_with("body.obj", text) + parts);
    inextensible::ContactPlane plane{};
    inextensible::WorkCounters work;
    EXPECT_TRUE(scene.problem->collider()->plane_at({0.3, -2.01, 0.1}, plane, work)) << text;
    return plane.normal;
  };
  const std::string sides = "f 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";
  for (const char* ends :
       {"f 1 2 3 4\nf 8 7 6 5\n", "f 4 3 2 1\nf 8 7 6 5\n", "f 1 2 3 4\nf 5 6 7 8\n"})
    EXPECT_LT((top(corners + sides + ends) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12) << ends;
  // Each face with corners of its own.
  const MeshFile box =
      read_mesh_file(file_with("box.obj", corners + sides + "f 1 2 3 4\nf 8 7 6 5\n"));
  std::ostringstream split;
  for (const auto& face : box.faces) {
    for (const int v : face.corners) split << "v " << box.vertices[v].transpose() << '\n';
    split << "f -4 -3 -2 -1\n";
  }
  EXPECT_LT((top(split.str(), ",weld=1e-6") - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  const auto refused = [&](const std::string& text, const char* part) {
    EXPECT_TRUE(refuses([&] { find_scene(sheet + file_with("body.obj", text)); }, part));
  };
  refused(split.str(), "has 1 face, a closed surface has 2; --weld 1e-6 joins doubled corners");
  refused(corners + sides, "vertices 1 and 2 has 1 face");
  refused(std::regex_replace(corners, std::regex("-2"), "-.4") + sides + "f 1 2 3 4\nf 8 7 6 5\n",
          "8 of 16 vertices begin inside the body, as deep as 0.6");
}

// Seen along z, with the pins in the highest row; also where nothing holds it yet, or it cannot
// move.
TEST(MeshScene, IsDescribedAndDrawn) {
  const std::string twice = square(5) + "f 6 7 2 1\n";  // its first face from behind
  const std::string text = find_scene(mesh(twice))->description;
  for (const char* part : {"25 vertices, 17 faces", "1 piece\n", "unit: 1 x 1 x 0 m", "twice: 1",
                           "16 quads, of which 0 are two triangles", "constraints: 36 sides",
                           "pinned: 5 vertices; loaded: 0 vertices", "along z"})
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
  const std::string drawn = text.substr(text.find('\n', text.find("along z")) + 1);
  EXPECT_EQ(std::ranges::count(drawn, 'o'), 5);
  EXPECT_EQ(std::ranges::count(drawn.substr(0, drawn.find('\n')), 'o'), 5) << text;
  EXPECT_EQ(drawn.find_first_not_of(" .o\n"), std::string::npos) << text;
}

TEST(MeshScene, WhatCanBeNoClothIsRefusedInALine) {
  const std::string good = file_with("good.obj", square(3));
  const std::string two = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const auto scene_of = [](const std::string& file, const std::string& text) {
    return "mesh:" + file_with(file + ".obj", text) + ",pins=v1";
  };
  const struct {
    std::string scene, part;
  } cases[] = {
      {"mesh:" + good, "nothing is pinned and nothing is below"},
      {"mesh:" + good + ",pins=y>5", "no vertex is where the pins are"},
      {"mesh:" + good + ",pins=height>1", "must be like y>1.2"},
      {"mesh:" + good + ",pins=y>", "must be like y>1.2"},
      {"mesh:" + good + ",colour=red", "must begin with pins="},
      {"mesh:" + good + ",body=" + good, "not a body to collide with"},
      {"mesh:nowhere.obj,pins=y>0", "nowhere.obj"},
      {scene_of("empty", "# nothing\n"), "no faces and no lines"},
      {scene_of("short", "v 1 2\n"), "line 1: a vertex needs three"},
      {scene_of("beyond", two + "f 1 2 9\n"), "line 5: no vertex 9"},
      {"mesh:" + good + ",pins=v10", "has no vertex 10"},
      {"mesh:" + good + ",pins=y<9", "all vertices are pinned"},
      {"mesh:" + good + ",weld=-1", "must be a number of at least 0"},
      {scene_of("word", two + "vx 1\nf 1 2 3 4\n"), "line 5: 'vx' is no keyword"},
      {scene_of("flat", two + "v 0 0 0\n\nf 1 2 3 4\nf 1 5 3\n"),
       "face 2 (line 8): its corners 1 and 5 are in one place"},
      {scene_of("line", two + "v 0 2 0\nf 1 2 3 4\nf 1 4 5\n"), "face 2 (line 7): it has no area"},
      {scene_of("bowtie", two + "f 1 2 4 3\n"), "it crosses itself"},
      {scene_of("one", two + "f 1 2 3\n"), "is constrained"},
      {scene_of("seam", two + "v 0 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4\nf 5 6 7 8\n"),
       "in 2 pieces, 1 of them pinned nowhere, as that of vertex 5; corners"},
      {scene_of("fan", two + "v 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n"),
       "between vertices 1 and 2 belongs to more than two faces"}};
  for (const auto& [scene, part] : cases)
    EXPECT_TRUE(refuses([&name = scene] { find_scene(name); }, part)) << scene;
  EXPECT_THROW((void)with_mesh_parts("drape", {{"pins", "y > 1"}}), UsageError);
}

// What is measured of one mesh is not taken for another of the same name.
TEST(MeshScene, IsItsContent) {
  const std::string file = file_with("changes.obj", square(3));
  const std::string before = with_mesh_parts("mesh:" + file, {{"pins", "y >= 0 and x < .1"}});
  EXPECT_EQ(find_scene(before)->name, before);
  EXPECT_TRUE(before.starts_with("mesh:" + file + ",pins=y>=0andx<.1,content=")) << before;
  file_with("changes.obj", square(4));
  EXPECT_NE(with_mesh_parts("mesh:" + file, {{"pins", "y >= 0 and x < .1"}}), before);
  EXPECT_TRUE(refuses([&] { mesh_scene(before); }, "has changed"));
}

// A rope of the file's lines is the chain that the chain's scene makes; each link is cut into n.
TEST(MeshScene, LinesAreRopes) {
  std::ostringstream rope;
  for (int i = 0; i <= 8; ++i) rope << "v " << i / 8.0 << " 0 0\n";
  rope << "l 1 2 3 4\nl 4 5 6 7 8 9\n";
  const std::string name = mesh(rope.str(), ",pins=v1,load=v9");
  const Scene once = built_scene(name, {{"line_density", 2}, {"load", 3}});
  EXPECT_EQ(joined_places(once), joined_places(built_scene("chain", {{"n", 9}})));
  EXPECT_NEAR(once.problem->total_mass(), 2 * 1 + 3, 1e-12);
  EXPECT_NEAR(once.problem->mass()[8], 3 + 2.0 / 16, 1e-12);
  const Scene cut = built_scene(name, {{"n", 3}, {"line_density", 2}, {"load", 3}});
  EXPECT_EQ(cut.problem->constraints(), 24);
  EXPECT_EQ(find_scene(name)->counts(testing::parameters(name, {{"n", 3}})), std::pair(25, 24));
}

// Cloth on strings: faces and lines are one piece.
TEST(MeshScene, LinesHoldCloth) {
  const std::string swing = square(3) + "v 0 1 0\nl 10 1\nl 10 3\n";
  EXPECT_EQ(built_scene(mesh(swing, ",pins=v10")).problem->constraints(), 12 + 2);
}

// A second panel below, joined by lines: of no length they sew, and longer ones are said to stay.
TEST(MeshScene, LinesBetweenPanelsAreSewnOrReported) {
  const auto panels = [](double gap) {
    return square(3) + concat("v 0 ", -1 - gap, " 0\nv 1 ", -1 - gap, " 0\nv 1 -2 0\nv 0 -2 0\n",
                              "f 10 11 12 13\nl 7 10\nl 9 11\n");
  };
  const Scene sewn = built_scene(mesh(panels(0)));
  EXPECT_EQ(sewn.problem->vertices(), 9 + 2);
  EXPECT_EQ(sewn.problem->constraints(), 10 + 4);
  EXPECT_NE(find_scene(mesh(panels(0)))->remarks.find("2 without length"), std::string::npos);
  EXPECT_EQ(built_scene(mesh(panels(0.5))).problem->constraints(), 10 + 4 + 2);
  EXPECT_NE(find_scene(mesh(panels(0.5)))->remarks.find("2 between faces"), std::string::npos);
  EXPECT_EQ(find_scene(mesh(square(3)))->remarks, "");
}

// Sheared by 45 degrees, the halves of its quads make better quads with their neighbours' halves.
// The texture, which is not sheared, or turned so that it says nothing, or the other way round.
TEST(MeshScene, TheTextureTellsWarpFromWeft) {
  constexpr int n = 6;
  const auto sheared = [](bool cut, double turn) {
    std::ostringstream vertices, faces;
    vertices.precision(17);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        vertices << "v " << j - i << ' ' << -i << " 0\nvt "
                 << j * std::cos(turn) - i * std::sin(turn) << ' '
                 << j * std::sin(turn) + i * std::cos(turn) << '\n';
    for (int i = 0; i + 1 < n; ++i)
      for (int j = 0; j + 1 < n; ++j) {
        const int a = i * n + j + 1, b = a + 1, c = b + n, d = a + n;
        faces << (cut ? halves(true, a, b, c, d) : concat("f ", a, ' ', b, ' ', c, ' ', d, '\n'));
      }
    const std::string number = turn < 0 ? " $1" : " $1/$1";
    return mesh(vertices.str() + std::regex_replace(faces.str(), std::regex(" (\\d+)"), number),
                ",pins=v1");
  };
  const double without = -1, diagonal = 0.25 * std::numbers::pi, other = 0.5 * std::numbers::pi;
  const auto quads = joined_places(built_scene(sheared(false, without)));
  for (const double turn : {0.0, 0.2, other})
    EXPECT_EQ(joined_places(built_scene(sheared(true, turn))), quads) << turn;
  EXPECT_NE(joined_places(built_scene(sheared(true, without))), quads);
  EXPECT_EQ(joined_places(built_scene(sheared(true, diagonal))),
            joined_places(built_scene(sheared(true, without))));
  for (const bool cut : {false, true})
    for (const double turn : {0.0, other}) {
      const std::string name = sheared(cut, turn);
      for (const int fine : {1, 2}) {
        const SceneParameters size{{"n", fine}}, limp{{"n", fine}, {"weft_bending", 0}};
        const auto all = built_scene(name, size).problem->bending();
        const Scene warp = built_scene(name, limp);
        EXPECT_EQ(2 * warp.problem->bending().size(), all.size());
        for (const auto& stencil : warp.problem->bending()) {
          const auto y = warp.start.x.row(1);
          EXPECT_EQ(std::abs(y[stencil.vertex[2]] - y[stencil.vertex[0]]) < 1e-9,
                    turn == 0);  // rows run along u, or columns do
        }
      }
    }
}

// A cloth that hangs from its upper edge, with weft upright. Weft may stretch three times as far.
TEST(MeshScene, WeftMayHaveALimitOfItsOwn) {
  constexpr int n = 9;
  std::ostringstream text;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      text << "v " << 0.1 * j << ' ' << -0.1 * i << " 0\nvt " << j << ' ' << -i << '\n';
  for (int a = 1; a < n * (n - 1); ++a)
    if (a % n != 0)
      text << concat("f ", a, '/', a, ' ', a + n, '/', a + n, ' ', a + n + 1, '/', a + n + 1, ' ',
                     a + 1, '/', a + 1, '\n');
  const std::string name = mesh(text.str(), ",pins=y>-0.05");
  constexpr double limit = 0.002;
  for (const auto& [weft_limit, scale_warp] : {std::pair(3.0, 1.0), {1 / 3.0, 3.0}}) {
    const Scene scene = built_scene(name, {{"weft_limit", weft_limit}});
    const Problem& problem = *scene.problem;
    const auto is_warp = [&](std::size_t k) {
      const auto [a, b] = problem.edges()[k];
      return std::abs(scene.start.x(1, a) - scene.start.x(1, b)) < 1e-9;
    };
    for (std::size_t k = 0; k < problem.edges().size(); ++k)
      EXPECT_NEAR(problem.limit_scale()[k], is_warp(k) ? scale_warp : 3 / scale_warp, 1e-12);
    for (const char* solver : {"gauss_seidel", "fast_projection", "shake", "icd", "jacobi",
                               "gauss_seidel_colored@bdf2", "yarn_projection", "admm"}) {
      const auto stepper = inextensible::make_stepper(solver, scene.problem, {limit});
      State state = scene.start;
      double most = 0, most_of_tight = 0, raw = 0;
      for (int i = 0; i < 100; ++i) {
        ASSERT_TRUE(stepper->advance(state, 0.005)) << solver;
        most = std::max(most, strain_range(problem, state.x).most);
        for (std::size_t k = 0; k < problem.edges().size(); ++k) {
          const auto [a, b] = problem.edges()[k];
          const double strain =
              std::abs((state.x.col(a) - state.x.col(b)).norm() / problem.rest_length()[k] - 1);
          raw = std::max(raw, strain);
          if (problem.limit_scale()[k] == 1) most_of_tight = std::max(most_of_tight, strain);
        }
      }
      EXPECT_LE(most, limit * (1 + 1e-9)) << solver << ", over what each may have";
      EXPECT_LE(most_of_tight, limit * (1 + 1e-9)) << solver;
      if (weft_limit > 1 && std::string(solver) == "gauss_seidel") {
        EXPECT_GT(raw, 1.5 * limit);
      }
    }
  }
}

TEST(MeshScene, BeginsAwayFromItsRestShape) {
  const std::string flat = file_with("pattern.obj", square(4));
  std::string folded = std::regex_replace(square(4), std::regex("v (\\S+) (\\S+) (\\S+)"),
                                          "v $1 -2 $2");  // laid down
  const std::string name = "mesh:" + file_with("laid.obj", folded) + ",floor=-2.5,rest=" + flat;
  const Scene scene = built_scene(name, {{"n", 2}}),
              rest = built_scene("mesh:" + flat + ",pins=v1", {{"n", 2}});
  EXPECT_EQ(scene.problem->rest_length(), rest.problem->rest_length());
  for (Eigen::Index v = 0; v < scene.start.x.cols(); ++v) EXPECT_EQ(scene.start.x(1, v), -2);
  inextensible::ContactPlane plane{};
  inextensible::WorkCounters work;
  ASSERT_TRUE(scene.problem->collider()->plane_at({3, -2.501, 1}, plane, work));
  EXPECT_EQ(plane.normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(plane.offset, -2.5);
  EXPECT_THROW((void)built_scene("mesh:" + flat + ",floor=0.5"), std::invalid_argument);
  const std::string other = file_with("other.obj", square(5));
  EXPECT_TRUE(refuses([&] { find_scene("mesh:" + other + ",pins=v1,rest=" + flat); },
                      "other faces or lines"));
}

// Triangles of equal sides on a square of n x n rows, turned by `way` and rolled onto a cylinder.
std::string rolled(int n, double radius, double way = 0) {
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double u = (j + 0.5 * (i % 2)) / n, v = std::sqrt(0.75) * i / n;
      const double x = std::cos(way) * u - std::sin(way) * v, turned = x / radius;
      text << "v " << radius * std::sin(turned) << ' ' << radius * (std::cos(turned) - 1) << ' '
           << std::sin(way) * u + std::cos(way) * v << '\n';
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j + 1, b = a + 1, c = b + n + 1, d = a + n + 1;
      text << halves(i % 2, a, b, c, d);
    }
  return text.str();
}

// A cylinder, flat at rest, has the energy B / (2 radius^2) an area, and sides keep their length.
TEST(MeshScene, TrianglesByMidpointsRollWithoutStretching) {
  const double rigidity = 0.01, radius = 1.5;
  for (const double way : {0.0, 0.3, 0.9, std::numbers::pi / 2}) {
    const std::string flat = file_with("flat.obj", rolled(32, 1e4, way)),
                      bent = file_with("bent.obj", rolled(32, radius, way));
    const Scene scene = built_scene(
        "mesh:" + bent + ",pins=v1,rest=" + flat + ",triangles=midpoints", {{"bending", rigidity}});
    const inextensible::Problem& problem = *scene.problem;
    EXPECT_FALSE(problem.shear());
    EXPECT_LT(strain_range(problem, scene.start.x).most, 1e-3);
    const double area = std::sqrt(0.75);
    EXPECT_NEAR(problem.total_mass(), 0.15 * area, 1e-6);
    const double energy = inextensible::bending_energy(problem.bending(), scene.start.x);
    EXPECT_NEAR(energy / area, 0.5 * rigidity / (radius * radius), 0.08 * energy / area) << way;
  }
}

// Held by one side it hangs down and sways, whereas triangles that keep their sides would stay.
TEST(MeshScene, TrianglesByMidpointsDoNotLock) {
  const Scene scene = built_scene(mesh(rolled(6, 1e4), ",pins=x<0.01,triangles=midpoints"));
  const int constraints = scene.problem->constraints();
  EXPECT_LT(constraints, 3 * scene.problem->vertices() - 6 * 6);
  inextensible::State state = scene.start;
  const auto stepper = inextensible::make_stepper("fast_projection", scene.problem, {0.01});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(stepper->advance(state, 0.005));
  EXPECT_LT(strain_range(*scene.problem, state.x).most, 0.01 + 1e-9);
  EXPECT_LT(state.x.row(1).minCoeff(), -0.5);
}

TEST(MeshScene, BodiesMayBeSeveralOpenAndMoving) {
  const auto box = [](const char* name, double x, double turn) {
    return block_file(name, {x - 0.2, -1.4, -0.2}, {x + 0.2, -1.1, 0.2}, turn);
  };
  const std::string cloth = mesh(square(5));
  const std::string one = box("one.obj", 0, 0), two = box("two.obj", 1, 0),
                    later = box("later.obj", 0, 1);
  const Scene both = built_scene(cloth + ",body=" + one + ";" + two);
  EXPECT_EQ(both.problem->collider()->triangles(), 24);
  EXPECT_TRUE(refuses([&] { find_scene(cloth + ",body=" + one + ";" + later); }, "apart"));
  const Scene standing = built_scene(cloth + ",body=" + one + ",floor=-1.4");
  EXPECT_EQ(standing.problem->collider()->triangles(), 24);
  EXPECT_TRUE(refuses(
      [&] { find_scene(cloth + ",body=" + one + ",floor=-1.4,body_then=" + later); }, "exclude"));
  const Scene moving = built_scene(cloth + ",body=" + one + ",body_then=" + later,
                                   {{"duration", 2}, {"scale", 0.5}});
  const inextensible::Pose half = moving.problem->body_motion()(1);
  EXPECT_NEAR(half.turn(0, 2), std::sin(0.5), 1e-9);
  EXPECT_LT(half.translation.norm(), 1e-9);
  const std::string then = two + ";" + file_with("bent.obj", rolled(2, 1));
  EXPECT_TRUE(
      refuses([&] { find_scene(cloth + ",body=" + one + ",body_then=" + then); }, "vertices"));
  EXPECT_TRUE(refuses([&] { find_scene(cloth + ",thickness=0.1"); }, "--collider"));
  // A sheet below the cloth, which gets a back.
  const std::string sheet =
      file_with("sheet.obj", "v -1 -1.2 -1\nv -1 -1.2 1\nv 1 -1.2 1\nv 1 -1.2 -1\nf 1 2 3 4\n");
  EXPECT_TRUE(refuses([&] { find_scene(cloth + ",body=" + sheet); }, ""));
  const Scene open = built_scene(cloth + ",body=" + sheet + ",thickness=0.1");
  const auto* body = dynamic_cast<const inextensible::TriangleCollider*>(open.problem->collider());
  EXPECT_NEAR(body->nearest({0, -1.25, 0}).signed_distance, -0.05, 1e-12);
  EXPECT_NEAR(body->nearest({0, -1.1, 0}).signed_distance, 0.1, 1e-12);
}

}  // namespace
}  // namespace harness
