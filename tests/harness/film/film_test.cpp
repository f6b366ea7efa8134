// Runs of films: at which step they are taken, what is said of them, and that they end; the strain
// that recordings hold, and a pixel of cloth.
#include <gtest/gtest.h>

#include <fstream>
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

// A flat square of n x n vertices, whose triangles are as a scene gives them: turned both ways.
Recording flat_square(int n) {
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
  recording.takes = {take};
  return recording;
}

std::array<int, 3> pixel(const Pixels& pixels, const Eigen::Vector2d& seen) {
  const auto column = static_cast<int>((seen.x() + 1) / 2 * pixels.width);
  const auto row = static_cast<int>((1 - seen.y()) / 2 * pixels.height);
  const auto* rgb = &pixels.rgb[static_cast<std::size_t>(3 * (row * pixels.width + column))];
  return {rgb[0], rgb[1], rgb[2]};
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

TEST(Pictures, ShowFlatCloth) {
  constexpr int width = 96;
  const Recording recording = flat_square(12);
  const View view = view_of(recording, {0});
  const Pixels pixels = trace(shot_of(recording, view, 0, 0, width), view, width, 2);
  EXPECT_LT(pixel(pixels, view.seen({0.5, 0, 0.5}))[2], 235) << "cloth, not the background";
}

TEST(Oriented, TrianglesPassACommonSideInOppositeDirections) {
  std::set<std::pair<int, int>> sides;
  for (const auto& t : flat_square(4).stage.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(sides.insert({t[k], t[(k + 1) % 3]}).second) << t[k] << ' ' << t[(k + 1) % 3];
}

}  // namespace
}  // namespace harness
