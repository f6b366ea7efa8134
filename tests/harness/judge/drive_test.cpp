// How drives end, and what their observers see, with steppers whose refusals are known.
#include "harness/judge/drive.h"

#include <gtest/gtest.h>

namespace harness {
namespace {

using End = DriveState::End;

constexpr double whole_step = 0.01;

// Stands still, and refuses what `accepts` does not like.
struct Picky final : Stepper {
  using Accepts = std::function<bool(double time, double h)>;
  Picky(const Scene& scene, Accepts accepts)
      : Stepper(scene.problem), accepts_(std::move(accepts)) {}

 private:
  StepResult solve(const State& state, double step, Positions& x) override {
    x = state.x;
    if (accepts_(state.time, step)) return {};
    return {Status::not_converged, 7, -1, 0, "not to my taste"};
  }
  Accepts accepts_;
};

struct Driving {
  explicit Driving(Picky::Accepts accepts = [](double, double) { return true; })
      : stepper(scene, std::move(accepts)) {}
  Scene scene = built_scene("chain", {{"n", 3}});
  State state = scene.start;
  Picky stepper;
};

TEST(Drive, TakesTheStepsOfItsPaceInBlocks) {
  struct : Observer {
    std::vector<int> blocks;
    std::vector<long> counted;
    int looks = 0;
    int before(State& /*state*/, const DriveState& /*driven*/) { return 3; }
    void each(const State& /*state*/, const DriveState& driven) { counted.push_back(driven.steps); }
    void all(const State& /*state*/, const DriveState& driven) { blocks.push_back(driven.taken); }
    bool after(const State& /*state*/, const DriveState& /*driven*/) { return ++looks > 0; }
  } look;
  Driving d;
  const DriveState driven = drive(d.stepper, d.state, {whole_step, 7}, look);
  EXPECT_EQ(driven.end, End::arrived);
  EXPECT_EQ(look.blocks, (std::vector<int>{3, 3, 1}));
  EXPECT_EQ(look.counted, (std::vector<long>{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(look.looks, 3);
  EXPECT_NEAR(d.state.time, 7 * whole_step, 1e-12);
}

TEST(Drive, EndsWithARefusalThatNobodyLooksAt) {
  Driving d([](double time, double) { return time <= 2.5 * whole_step; });
  int looks = 0;
  const DriveState driven =
      drive(d.stepper, d.state, {whole_step, 7}, [&](auto&&...) { return ++looks > 0; });
  EXPECT_EQ(driven.end, End::refused);
  EXPECT_EQ(driven.result.status, Status::not_converged);
  EXPECT_EQ(driven.result.iterations, 7);
  EXPECT_STREQ(driven.result.detail, "not to my taste");
  EXPECT_EQ(driven.steps + looks, 3 + 3);
}

TEST(Drive, HalvesStepsAsOftenAsItMay) {
  for (const int halvings : {1, 2}) {
    Driving d([](double, double h) { return h <= whole_step / 4; });
    int part = 0;
    const DriveState driven = drive(d.stepper, d.state, {whole_step, 2, halvings},
                                    [&](const State&, const DriveState& so_far) {
                                      ++part;
                                      EXPECT_EQ(so_far.whole, part % 4 == 0);
                                      EXPECT_EQ(so_far.steps, part / 4);
                                      return true;
                                    });
    EXPECT_EQ(driven.end, halvings == 1 ? End::refused : End::arrived);
    EXPECT_EQ(part, halvings == 1 ? 0 : 8);
    // After four steps of a quarter a half is tried again.
    EXPECT_EQ(d.stepper.work().rejected_steps, halvings == 1 ? 2 : 3);
    EXPECT_EQ(d.stepper.work().steps, part);
    if (halvings == 1) {
      EXPECT_EQ(driven.next, whole_step / 2) << "was refused as well";
      EXPECT_TRUE(d.state.x == d.scene.start.x && d.state.time == 0);
    }
    EXPECT_EQ(driven.smallest, halvings == 1 ? whole_step : whole_step / 4);
  }
}

TEST(Drive, GrowsBackAfterAHardStretchAndMeetsEveryMultipleOfItsStep) {
  Driving d([](double time, double h) { return time < 1 || time >= 2 || h < 0.2; });
  const DriveState driven =
      drive(d.stepper, d.state, {1, 8, 14}, [](const State& now, const DriveState& so_far) {
        EXPECT_EQ(so_far.whole, now.time == std::floor(now.time)) << now.time;
        // A step begins at a multiple of itself.
        EXPECT_EQ(std::fmod(now.time, so_far.last), 0) << now.time;
        return true;
      });
  EXPECT_EQ(driven.end, End::arrived);
  EXPECT_EQ(d.state.time, 8);
  EXPECT_EQ(driven.last, 1);
  EXPECT_EQ(driven.smallest, 0.125);
}

TEST(Drive, StopsWhereItIsToldTo) {
  Driving d;
  const auto three = [](const State&, const DriveState& driven) { return driven.steps < 3; };
  EXPECT_EQ(drive(d.stepper, d.state, {whole_step, 7}, three).end, End::stopped);
  const DriveState late = drive(d.stepper, d.state, {whole_step, 7}, {.timeout = -1});
  EXPECT_EQ(late.end, End::timed_out);
  EXPECT_EQ(late.steps, 1);
  EXPECT_EQ(drive(d.stepper, d.state, {whole_step, 1}, {.timeout = -1}).end, End::arrived);
  EXPECT_THROW(drive(d.stepper, d.state, {whole_step, 7}, {.interrupted = [] { return true; }}),
               Interrupted);
}

// The chain begins to fall freely: half a step back it rises at g h / 2.
TEST(Drive, StartsHalfAStepBackWhereVelocitiesAndSceneAskForIt) {
  Scene chain = built_scene("chain", {{"n", 3}});
  Backend backend = *find_backend("null");
  backend.velocities = Velocities::half_step;
  EXPECT_NEAR(start_of(chain, backend, whole_step).v(1, 2), 0.5 * 9.81 * whole_step, 1e-12);
  EXPECT_EQ(start_of(chain, backend, whole_step).x, chain.start.x);
  chain.staggered = false;
  EXPECT_EQ(start_of(chain, backend, whole_step).v, chain.start.v);
  chain.staggered = true;
  backend.velocities = Velocities::whole_step;
  EXPECT_EQ(start_of(chain, backend, whole_step).v, chain.start.v);
}

}  // namespace
}  // namespace harness
