// How drives end, and what their observers see, with a stepper that refuses long steps.
#include "harness/judge/drive.h"

#include <gtest/gtest.h>

namespace harness {
namespace {

using inextensible::State;
using End = DriveState::End;

constexpr double whole_step = 0.01;

class Picky : public inextensible::Stepper {
 public:
  Picky(const Scene& scene, double longest, double until = 1e9)
      : Stepper(scene.problem), longest_(longest), until_(until) {}

 protected:
  inextensible::StepResult solve(const State& state, double step,
                                 inextensible::Positions& x) override {
    if (step > longest_ || state.time > until_) return {inextensible::Status::not_converged};
    x = state.x;
    return {};
  }

 private:
  double longest_, until_;  // s
};

struct Driving {
  Scene scene = built_scene("chain", {{"n", 3}});
  State state = scene.start;
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
  Picky stepper(d.scene, 1);
  const DriveState driven = drive(stepper, d.state, {whole_step, 7}, look);
  EXPECT_EQ(driven.end, End::arrived);
  EXPECT_EQ(look.blocks, (std::vector<int>{3, 3, 1}));
  EXPECT_EQ(look.counted, (std::vector<long>{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(look.looks, 3);
  EXPECT_NEAR(d.state.time, 7 * whole_step, 1e-12);
}

TEST(Drive, EndsWithARefusalThatNobodyLooksAt) {
  Driving d;
  Picky stepper(d.scene, 1, 2.5 * whole_step);
  int looks = 0;
  const DriveState driven =
      drive(stepper, d.state, {whole_step, 7}, [&](auto&&...) { return ++looks > 0; });
  EXPECT_EQ(driven.end, End::refused);
  EXPECT_EQ(driven.result.status, inextensible::Status::not_converged);
  EXPECT_EQ(driven.steps + looks, 3 + 3);
}

TEST(Drive, HalvesStepsAsOftenAsItMay) {
  for (const int halvings : {1, 2}) {
    Driving d;
    Picky stepper(d.scene, whole_step / 4);
    int part = 0;
    const DriveState driven = drive(stepper, d.state, {whole_step, 2, halvings},
                                    [&](const State&, const DriveState& so_far) {
                                      ++part;
                                      EXPECT_EQ(so_far.whole, part % 4 == 0);
                                      EXPECT_EQ(so_far.steps, part / 4);
                                      return true;
                                    });
    EXPECT_EQ(driven.end, halvings == 1 ? End::refused : End::arrived);
    EXPECT_EQ(part, halvings == 1 ? 0 : 8);
    if (halvings == 1) {
      EXPECT_EQ(driven.next, whole_step / 2) << "was refused as well";
    }
    EXPECT_EQ(driven.smallest, halvings == 1 ? whole_step : whole_step / 4);
  }
}

TEST(Drive, StopsWhereItIsToldTo) {
  Driving d;
  Picky stepper(d.scene, 1);
  const auto three = [](const State&, const DriveState& driven) { return driven.steps < 3; };
  EXPECT_EQ(drive(stepper, d.state, {whole_step, 7}, three).end, End::stopped);
  const DriveState late = drive(stepper, d.state, {whole_step, 7}, {.timeout = -1});
  EXPECT_EQ(late.end, End::timed_out);
  EXPECT_EQ(late.steps, 1);
  EXPECT_EQ(drive(stepper, d.state, {whole_step, 1}, {.timeout = -1}).end, End::arrived);
  EXPECT_THROW(drive(stepper, d.state, {whole_step, 7}, {.interrupted = [] { return true; }}),
               Interrupted);
}

// The chain begins to fall freely: half a step back it rises at g h / 2.
TEST(Drive, StartsHalfAStepBackWhereVelocitiesAndSceneAskForIt) {
  Scene chain = built_scene("chain", {{"n", 3}});
  inextensible::Backend backend = *inextensible::find_backend("null");
  backend.velocities = inextensible::Velocities::half_step;
  EXPECT_NEAR(start_of(chain, backend, whole_step).v(1, 2), 0.5 * 9.81 * whole_step, 1e-12);
  EXPECT_EQ(start_of(chain, backend, whole_step).x, chain.start.x);
  chain.staggered = false;
  EXPECT_EQ(start_of(chain, backend, whole_step).v, chain.start.v);
  chain.staggered = true;
  backend.velocities = inextensible::Velocities::whole_step;
  EXPECT_EQ(start_of(chain, backend, whole_step).v, chain.start.v);
}

}  // namespace
}  // namespace harness
