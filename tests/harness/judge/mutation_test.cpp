// The error is tested by mutation: a run of the wrong physics is off by more than the headline's
// level, and one of the right physics is not.

#include "harness/base/files.h"
#include "harness/judge/drive.h"
#include "harness/judge/judge.h"
#include "support/random_mesh.h"
#include "support/scenes.h"

namespace harness {
namespace {

// The error of the scene's run by fast projection in BDF2, where the judge knows the scene itself.
double error_of(const std::string& name, const SceneParameters& given,
                const SceneParameters& changed, double h,
                const std::function<void(ProblemParts&)>& change = {}) {
  SceneParameters own = given;
  for (const auto& [parameter, value] : changed) own[parameter] = value;
  const Scene scene = built_scene(name, given);
  auto problem = built_scene(name, own).problem;
  if (change) {
    ProblemParts parts = inextensible::testing::parts_of(*problem);
    change(parts);
    problem = std::make_shared<const Problem>(std::move(parts));
  }
  const auto reference = ReferenceFolder::usual()->find(name, testing::parameters(name, given));
  if (!reference) throw std::runtime_error("no reference of " + name);
  constexpr const char* solver = "fast_projection@bdf2";
  Judge judge(scene, {.reference = reference, .velocities = find_backend(solver)->velocities});
  const auto stepper = make_stepper(solver, problem, {1e-5, 1, {{"min_iterations", 1.0}}});
  State state = start_of(scene, *find_backend(solver), h);
  const long steps = std::lround(scene.duration / h);
  judge.before(state, h);
  drive(*stepper, state, {h, steps}, [&](const State& now, const DriveState&) {
    judge.after(stepper->filtered_positions(), now, h);
    judge.before(now, h);
    return true;
  });
  return judge.finish().trajectory;
}

TEST(Mutation, OfTheSettlingDrapeIsDetected) {
  if (inextensible::testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  const SceneParameters drape{{"n", 21}};
  const double h = 1.0 / 1600;
  EXPECT_LT(error_of("settling_drape", drape, {}, h), 0.5 * headline_error);
  const SceneParameters own = testing::parameters("settling_drape", drape);
  const auto times = [&](const char* name, double factor) {
    return SceneParameters{{name, factor * own.at(name)}};
  };
  for (const auto& wrong : {times("friction", 0), times("friction", 0.5), times("shear", 0.5),
                            times("bending", 2), times("drag", 0.5), times("density", 2)}) {
    EXPECT_GT(error_of("settling_drape", drape, wrong, h), headline_error)
        << wrong.begin()->first << ' ' << wrong.begin()->second;
  }
  // Friction of 0.3 holds the cloth as 0.6 does: docs/measuring.md says so.
  EXPECT_LT(error_of("settling_drape", drape, times("friction", 2), h), headline_error);
}

TEST(Mutation, OfTheChainIsDetected) {
  const SceneParameters chain{{"n", 20}};
  const double h = 1.0 / 1600;
  EXPECT_LT(error_of("chain", chain, {}, h), 0.1 * headline_error);
  // Detected at the next level, of 1 %.
  EXPECT_GT(error_of("chain", chain, {{"gravity", 0.98 * 9.81}}, h), 0.01);
  EXPECT_GT(error_of("chain", chain, {}, h, [](auto& parts) { parts.mass.back() *= 2; }),
            headline_error);
}

// Every committed reference of the headline's cloth is sure at the headline's level to its end.
TEST(Reference, OfTheSettlingDrapeIsSureToItsEnd) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_path("results/references"))) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("settling_drape-") || !name.ends_with(".json")) continue;
    const Reference r = read_reference(entry.path().string());
    EXPECT_EQ(r.samples_at(headline_error), std::ssize(r.times)) << name;
    EXPECT_NEAR(r.valid_until, r.parameters.at("duration"), 1e-9) << name;
    EXPECT_GT(r.gap_parts.count("third_route"), 0u) << name;
    ++found;
  }
  EXPECT_GE(found, 2);
}

}  // namespace
}  // namespace harness
