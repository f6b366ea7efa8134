// Runs of films: at which step they are taken, what is said of them, and that they end. Pictures,
// judged by their pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/base/files.h"
#include "harness/film/pictures.h"
#include "harness/film/recording.h"
#include "solvers/registry.h"

namespace harness {
namespace {

FilmRun filmed(const std::string& scene, const SceneParameters& given, const Contestant& contestant,
               double limit, std::optional<double> step) {
  FilmSpec spec;
  spec.scene = scene;
  spec.parameters = complete_parameters(*find_scene(scene), given);
  spec.solvers = {contestant};
  spec.strain_limits = {limit};
  spec.step = step;
  Recording recording = record(
      spec, [] { return false; }, [](auto&&...) {});
  return recording.takes.at(0);
}

// Throws one vertex upwards, in steps that are longer than its own limit.
struct Thrower final : inextensible::VelocityFilter {
  static constexpr double longest_step = 0.005;  // s
  inextensible::StepResult apply(const inextensible::Positions&, double h, inextensible::Iterate x,
                                 inextensible::WorkCounters&) override {
    if (h > longest_step) x.positions().rightCols<1>() += Eigen::Vector3d(0, 0.1, 0);
    return {};
  }
};

const bool thrower_is_there = [] {
  const inextensible::Backend row{
      .name = "thrower",
      .summary = "adds energy in long steps",
      .strain_control = inextensible::StrainControl::none,
      .contestant = false,
      .settings = {},
      .make_filter = [](const inextensible::Problem&, const inextensible::BackendOptions&,
                        inextensible::Along) -> std::unique_ptr<inextensible::VelocityFilter> {
        return std::make_unique<Thrower>();
      }};
  inextensible::add_backends({&row, 1});
  return true;
}();

TEST(Films, TakeAStepAtWhichNoEnergyIsGainedUnlessOneIsGiven) {
  ASSERT_TRUE(thrower_is_there);
  const auto chain = [](std::optional<double> step) {
    return filmed("chain", {{"n", 13}}, {"thrower", "thrower"}, 0.01, step);
  };
  const FilmRun given = chain(default_step), chosen = chain({});
  EXPECT_DOUBLE_EQ(given.step, 1.0 / 120);
  ASSERT_NE(given.energy_gained, "") << "a step that is given is taken, and the run is marked";
  EXPECT_EQ(chosen.energy_gained, "");
  EXPECT_DOUBLE_EQ(chosen.step, 1.0 / 240);
  EXPECT_EQ(chosen.frames.size(), given.frames.size());
}

// A body that moves does work, so that sweeps do not judge energy there. Thrown over the body, the
// skirt gains nine times what the body can do.
TEST(Films, JudgeEnergyBesideABodyThatMoves) {
  const auto garment = [](std::optional<double> step) {
    return filmed("garment", {{"n", 40}, {"duration", 1}},
                  {"yarn_projection@bdf2", "yarn_projection@bdf2"}, 0.01, step);
  };
  const FilmRun chosen = garment({});
  EXPECT_EQ(chosen.energy_gained + chosen.detail, "");
  const FilmRun fine = garment(0.001);
  EXPECT_EQ(fine.energy_gained + fine.detail, "");
  const auto mean_height = [](const FilmRun& take) { return take.frames.back().row(1).mean(); };
  EXPECT_NEAR(mean_height(chosen), mean_height(fine), 0.04) << "m; the skirt is 0.4 long";
}

// Each step takes a hundred thousand passes: by default it would be refused, halved and so on.
TEST(Films, EndRunsWhoseStepsTakeTooMuchWork) {
  const FilmRun take =
      filmed("chain", {{"n", 80}}, {"jacobi", "jacobi", {{"max_iterations", 1e9}}}, 1e-8, 0.01);
  EXPECT_NE(take.detail.find("iterations for"), std::string::npos) << take.detail;
  EXPECT_LT(take.frames.size(), 31U);
}

using Eigen::Vector3d;
using inextensible::Positions;

constexpr int width = 96;

// A flat square of n x n vertices, whose triangles are as a scene gives them: turned both ways.
Recording flat_square(int n, std::size_t takes = 1) {
  Recording recording;
  recording.spec.scene = "test";
  FilmRun take;
  take.strain_limit = 0.01;
  Positions x(3, n * n);
  for (int v = 0; v < n * n; ++v)
    x.col(v) = Vector3d(v % n, 0, static_cast<double>(v / n)) / (n - 1);
  take.frames = {x};
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * n + j;
      if (j + 1 < n) recording.stage.edges.push_back({a, a + 1});
      if (i + 1 < n) recording.stage.edges.push_back({a, a + n});
      if (i + 1 == n || j + 1 == n) continue;
      triangles.push_back({a, a + 1, a + n});
      triangles.push_back({a + n + 1, a + 1, a + n});
    }
  }
  recording.stage.triangles = oriented(triangles);
  recording.stage.rest_length.assign(recording.stage.edges.size(), 1.0 / (n - 1));
  recording.takes.assign(takes, take);
  return recording;
}

// An octahedron of a radius about a point.
void add_body(Recording& recording, const Vector3d& middle, double radius) {
  for (const double side : {-radius, radius})
    for (int axis = 0; axis < 3; ++axis)
      recording.stage.body.push_back(middle + side * Vector3d::Unit(axis));
  recording.stage.body_triangles = {{3, 4, 5}, {4, 0, 5}, {0, 1, 5}, {1, 3, 5},
                                    {4, 3, 2}, {0, 4, 2}, {1, 0, 2}, {3, 1, 2}};
}

View view_of_all(const Recording& recording) {
  std::size_t most = 0;
  for (const FilmRun& take : recording.takes) most = std::max(most, take.frames.size());
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < most; ++i) frames.push_back(i);
  return view_of(recording, frames);
}

std::array<int, 3> pixel(const Pixels& pixels, const Eigen::Vector2d& seen) {
  const auto column = static_cast<int>((seen.x() + 1) / 2 * pixels.width);
  const auto row = static_cast<int>((1 - seen.y()) / 2 * pixels.height);
  const auto* rgb = &pixels.rgb[static_cast<std::size_t>(3 * (row * pixels.width + column))];
  return {rgb[0], rgb[1], rgb[2]};
}

// The first frame of the first take.
Pixels traced(const Recording& recording, int pixels_wide) {
  const View view = view_of_all(recording);
  return trace(shot_of(recording, view, 0, 0, pixels_wide), view, pixels_wide, 2);
}

// One corner is drawn away by 2 % of an edge along its row, twice the limit; 60 units are the
// limit.
TEST(Recordings, HoldTheStrainOfEachVertexOverTheLimit) {
  Recording recording = flat_square(4);
  recording.takes[0].frames[0](0, 0) -= 0.02 / 3;
  const TemporaryFolder folder("strains");
  write_recording(folder.path(), recording);
  std::ifstream file(folder.path() + "/film.u8", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::string expected(16, '\0');
  expected[0] = expected[1] = 120;
  expected[4] = 1;  // its column's edge is turned, and longer by (0.02)^2 / 2
  EXPECT_EQ(bytes, expected);
}

TEST(Pictures, OfFlatClothHaveOneShade) {
  const Recording recording = flat_square(12);
  const View view = view_of_all(recording);
  Shot shot = shot_of(recording, view, 0, 0, width);
  shot.yarn_shade = 0;
  const Pixels pixels = trace(shot, view, width, 2);
  std::array<int, 3> least{255, 255, 255}, most{0, 0, 0};
  for (double x = 0.05; x < 0.96; x += 0.05) {
    for (double z = 0.05; z < 0.96; z += 0.05) {
      const auto rgb = pixel(pixels, view.seen({x, 0, z}));
      for (std::size_t k = 0; k < 3; ++k) {
        least[k] = std::min(least[k], rgb[k]);
        most[k] = std::max(most[k], rgb[k]);
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(most[k] - least[k], 2);
  EXPECT_LT(most[2], 235) << "cloth was seen, not the background";
}

TEST(Pictures, ShowYarnsAsDarkerLinesAndStrainAsColour) {
  Recording recording = flat_square(5);
  View view = view_of_all(recording);
  const Pixels pixels = traced(recording, 300);
  const auto red = [&](double x, double z) { return pixel(pixels, view.seen({x, 0, z}))[0]; };
  EXPECT_LT(red(0.5, 0.4) + 25, red(0.6, 0.4));
  EXPECT_LT(red(0.4, 0.5) + 25, red(0.4, 0.6));
  recording.takes[0].frames[0] *= 1.04;  // four times the limit
  view = view_of_all(recording);
  const auto rgb = pixel(traced(recording, 300), view.seen({0.6, 0, 0.4}));
  EXPECT_GT(rgb[0], 1.6 * rgb[2]);
}

// Vertices that contact leaves on the body, and what hangs between them inside it, are seen.
TEST(Pictures, ShowClothThatLiesOnABodyWhole) {
  Recording recording = flat_square(5);
  add_body(recording, {0.5, -0.35, 0.5}, 0.4);  // its upper corner is 0.05 m above the cloth
  const View view = view_of_all(recording);
  std::array<std::array<int, 3>, 2> rgb{};
  for (auto& seen : rgb) {
    seen = pixel(trace(shot_of(recording, view, 0, 0, width), view, width, 2),
                 view.seen({0.53, 0, 0.56}));
    recording.stage.body.clear();
    recording.stage.body_triangles.clear();
  }
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(rgb[0][k], rgb[1][k], 12) << "cloth, not the body";
}

TEST(View, StaysOnTheBodyWhenClothFallsOff) {
  Recording recording = flat_square(5);
  add_body(recording, {0.5, -0.4, 0.5}, 0.4);
  const View still = view_of_all(recording);
  recording.takes[0].frames.push_back(recording.takes[0].frames[0].colwise() - Vector3d(0, 100, 0));
  const View fallen = view_of_all(recording);
  EXPECT_EQ(still.size, fallen.size);
  EXPECT_EQ(still.eye, fallen.eye);
}

TEST(View, SeesTheBodyInAllItsPoses) {
  Recording recording = flat_square(5);
  add_body(recording, {0.5, -0.4, 0.5}, 0.4);
  for (const double way : {0.0, 0.7, -0.7}) {
    recording.stage.body_poses.push_back({Eigen::Matrix3d::Identity(), Vector3d(way, 0, 0)});
    recording.takes[0].frames.push_back(recording.takes[0].frames[0]);
  }
  recording.takes[0].frames.pop_back();
  const View view = view_of_all(recording);
  for (std::size_t frame = 0; frame < 3; ++frame) {
    const auto body = body_at(recording.stage, frame);
    for (const auto& corner : body.colwise())
      EXPECT_LE(view.seen(corner).cwiseAbs().maxCoeff(), 1) << "frame " << frame;
  }
}

TEST(Oriented, TrianglesPassACommonSideInOppositeDirections) {
  std::set<std::pair<int, int>> sides;
  for (const auto& t : flat_square(4).stage.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(sides.insert({t[k], t[(k + 1) % 3]}).second) << t[k] << ' ' << t[(k + 1) % 3];
}

TEST(WritePictures, EndsATakeWithItsLastFrame) {
  Recording recording = flat_square(3, 2);
  recording.takes[0].frames.assign(4, recording.takes[0].frames[0]);
  const TemporaryFolder folder("pictures-test");
  PictureSpec spec;
  spec.frames = {0, 1, 2, 3};
  spec.width = 16;
  std::size_t told = 0;
  write_pictures(
      folder.path(), recording, spec, [] { return false; },
      [&](std::size_t, std::size_t all) { told = all; });
  EXPECT_EQ(told, 5U);
  EXPECT_TRUE(std::filesystem::exists(folder.file("0-3.ppm")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("1-0.ppm")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("1-1.ppm")));
  std::ifstream file(folder.file("pictures.json"));
  EXPECT_EQ(nlohmann::json::parse(file).at("width"), 16);
}

}  // namespace
}  // namespace harness
