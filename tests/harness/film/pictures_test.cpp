// Pictures of films, judged by their pixels.
#include "harness/film/pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/base/files.h"

namespace harness {
namespace {

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
