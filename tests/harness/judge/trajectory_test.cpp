// Scenes that leave the program as files and motions that come into it: nothing is lost on the way.
#include "harness/judge/trajectory.h"

#include <fstream>
#include <random>

#include "harness/base/files.h"
#include "harness/judge/drive.h"
#include "harness/run/fake_machine.h"
#include "harness/run/measure_point.h"
#include "harness/scenes/scene_folder.h"
#include "support/refusal.h"

namespace harness {
namespace {

// After some steps of a method that uses all parts of a scene. Counters must agree as well.
std::pair<State, std::int64_t> moved(const Scene& scene) {
  const auto& backend = *find_backend("gauss_seidel");
  State state = start_of(scene, backend, 0.004);
  const auto stepper = make_stepper("gauss_seidel", scene.problem, {0.01, 1, {}, &state});
  drive(*stepper, state, {0.004, 12});
  return {state, stepper->work().edge_projections};
}

TEST(SceneFolder, EverySceneReadsBackToTheLastBit) {
  for (const SceneType& type : scene_types()) {
    SCOPED_TRACE(type.name);
    const SceneParameters p = complete_parameters(type, {{"n", 9}});
    const TemporaryFolder folder("scene");
    write_scene(folder.path(), type.build(p), about(type, p));
    const SceneType again = folder_scene(folder.path());
    EXPECT_EQ(again.kind(), type.kind());
    const Scene scene = type.build(p), copy = again.build(complete_parameters(again, {}));
    EXPECT_EQ(copy.start.x, scene.start.x);
    EXPECT_EQ(copy.start.v, scene.start.v);
    EXPECT_EQ(copy.problem->pinned(), scene.problem->pinned());
    EXPECT_EQ(copy.size, scene.size);
    EXPECT_EQ(copy.energy_bound, scene.energy_bound);
    const auto [state, passes] = moved(scene);
    const auto [state_again, passes_again] = moved(copy);
    if (scene.problem->body_motion()) {  // poses are interpolated
      EXPECT_LT((state_again.x - state.x).cwiseAbs().maxCoeff(), 1e-5 * scene.size);
    } else {
      EXPECT_EQ(state_again.x, state.x);
      EXPECT_EQ(passes_again, passes);
    }
  }
}

TEST(SceneFolder, MistakesAreNamed) {
  const TemporaryFolder folder("scene");
  write_scene(folder.path(), built_scene("drape", {{"n", 5}}));
  const std::string path = folder.file("scene.json");
  const json good = parse_document(read_file(path, "scene"), path);
  const auto refused = [&](const json& patch, const std::string& named) {
    json bad = good;
    bad.merge_patch(patch);
    write_atomically(path, bad.dump());
    EXPECT_TRUE(refuses([&] { folder_scene(folder.path()); }, named));
  };
  refused({{"mass", nullptr}}, "mass");
  refused({{"mass", {1.0}}}, "mass");
  refused({{"rest_length", {0.25}}}, "rest");
  refused({{"edge", {{0, 99}}}, {"rest_length", {0.25}}}, "99");
  refused({{"sping", 1}}, "sping");
  refused({{"schema", "inextensible-scene/9"}}, "schema");
  refused({{"body", "nobody.obj"}}, "nobody.obj");
}

struct Exchange : ::testing::Test {
  const Scene scene = built_scene("drape", {{"n", 5}, {"duration", 0.2}});
  const TemporaryFolder folder{"trajectory"};
  Path frames{scene.start.x};
  std::vector<double> times{0};

  void SetUp() override {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1e-3);
    for (int k = 1; k <= 5; ++k) {
      frames.push_back(frames.back().unaryExpr([&](double x) { return x + noise(random); }));
      times.push_back(0.04 * k);
    }
  }
  std::string npz(const Path& path, const std::vector<double>& at) const {
    std::ofstream(folder.file("t.npz"), std::ios::binary)
        << npz_bytes({{"positions", array_of(path)}, {"times", {{at.size()}, at}}});
    return folder.file("t.npz");
  }
  void refused(const std::string& file, double rate, const std::string& named) const {
    EXPECT_TRUE(refuses([&] { read_trajectory({file}, scene, rate); }, named));
  }
};

TEST_F(Exchange, NumPyArraysComeBackToTheLastBit) {
  const Trajectory read = read_trajectory({npz(frames, times)}, scene, 0);
  EXPECT_EQ(read.frames, frames);
  EXPECT_DOUBLE_EQ(read.interval, 0.04);
  // Without the start, which is then put in.
  const Path later(frames.begin() + 1, frames.end());
  EXPECT_EQ(read_trajectory({npz(later, {times.begin() + 1, times.end()})}, scene, 0).frames,
            frames);
}

TEST_F(Exchange, FramesThatAreNotTheScenesAreRefused) {
  Path bad = frames;
  bad[3](1, 4) = std::nan("");
  refused(npz(bad, times), 0, "frame 4");
  for (Positions& x : bad = frames) x *= 100;
  refused(npz(bad, times), 0, "100 times as large");
  for (Positions& x : bad = frames) x = x.leftCols(24).eval();
  refused(npz(bad, times), 0, "24 vertices");
  refused(npz({frames.begin(), frames.end() - 2}, {0, 0.04, 0.08, 0.12}), 0, "missing");
  for (Positions& x : bad = frames) x = x.rowwise().reverse().eval();
  refused(npz(bad, times), 0, "order");
  refused(npz(frames, {0, 0.04, 0.08, 0.12, 0.16, 0.24}), 0, "equally spaced");
  refused(npz(frames, {0, 40, 80, 120, 160, 200}), 0, "times are in seconds");
  refused(npz(frames, times), 25, "times of its own");
  std::ofstream(folder.file("t.npz")) << "no archive";
  refused(folder.file("t.npz"), 25, ".npz");
}

// The judge's verdict on a solver's own frames is that of the solver's run.
TEST_F(Exchange, FramesOfARunAreJudgedAsTheRun) {
  PointSpec spec = spec_at("drape", {{"n", 5}, {"duration", 0.2}}, "gauss_seidel", 0.01);
  const PointResult run = run_point(spec, {.timed = false});
  auto played = std::make_shared<Trajectory>();
  played->interval = spec.step;
  State state = start_of(scene, *find_backend(spec.solver), spec.step);
  played->frames = {state.x};
  const auto stepper = make_stepper(spec.solver, scene.problem, {0.01, 1, {}, &state});
  drive(*stepper, state, {spec.step, 20}, [&](const State& now, const DriveState&) {
    played->frames.push_back(now.x);
    return true;
  });
  const Backend rows[] = {playback("played", "played", played)};
  inextensible::add_backends(rows);
  spec.contestant = spec.solver = "played";
  const PointResult judged = run_point(spec, {.timed = false});
  EXPECT_EQ(judged.status, run.status) << judged.detail;
  EXPECT_DOUBLE_EQ(judged.measures.max_strain, run.measures.max_strain_after_collision);
  EXPECT_NEAR(judged.measures.energy_gain, run.measures.energy_gain, 1e-12);
  EXPECT_NE(worst_places(*played, scene).find("largest strain"), std::string::npos);
}

}  // namespace
}  // namespace harness
