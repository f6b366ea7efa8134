// The step controller against steppers whose refusals are known.
#include "solvers/stepping/step_controller.h"

#include <gtest/gtest.h>

#include "support/contact.h"

namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;
using inextensible::Status;
using inextensible::StepController;
using inextensible::StepResult;

// Free flight that refuses what `accepts` does not like.
class Choosy final : public inextensible::Stepper {
 public:
  using Accepts = std::function<bool(double time, double h)>;
  explicit Choosy(Accepts accepts)
      : Stepper(std::make_shared<const Problem>(inextensible::testing::points(1, nullptr))),
        accepts_(std::move(accepts)) {}
  std::vector<double> attempts;

 private:
  StepResult solve(const State& state, double h, Positions& x) override {
    attempts.push_back(h);
    x = state.x + h * state.v;
    if (accepts_(state.time, h)) return {};
    return {Status::not_converged, 7, -1, 0, "not to my taste"};
  }
  Accepts accepts_;
};

TEST(StepController, HalvesToTheLargestAcceptedStepAndCountsEveryRefusal) {
  Choosy stepper([](double, double h) { return h <= 0.1; });
  StepController controller(stepper, {.largest = 1});
  State state{Positions::Zero(3, 1), Positions::Zero(3, 1), 0};
  ASSERT_TRUE(controller.advance(state));
  EXPECT_EQ(stepper.attempts, (std::vector<double>{1, 0.5, 0.25, 0.125, 0.0625}));
  EXPECT_EQ(controller.last(), 0.0625);
  EXPECT_EQ(state.time, 0.0625);
  EXPECT_EQ(stepper.work().rejected_steps, 4);
  EXPECT_EQ(stepper.work().steps, 1);
}

TEST(StepController, GrowsBackAfterAHardStretchAndMeetsEveryMultipleOfTheLargestStep) {
  Choosy stepper([](double time, double h) { return time < 1 || time >= 2 || h < 0.2; });
  StepController controller(stepper, {.largest = 1, .patience = 2});
  State state{Positions::Zero(3, 1), Positions::Zero(3, 1), 0};
  int aligned = 0;
  while (state.time < 6) {
    ASSERT_TRUE(controller.advance(state));
    EXPECT_EQ(controller.aligned(), state.time == std::floor(state.time)) << state.time;
    aligned += controller.aligned() ? 1 : 0;
    // A step begins at a multiple of itself.
    EXPECT_EQ(std::fmod(state.time, controller.last()), 0) << state.time;
  }
  EXPECT_EQ(aligned, 6);
  EXPECT_EQ(controller.last(), 1);
  EXPECT_EQ(controller.smallest(), 0.125);
}

TEST(StepController, GivesUpBelowTheSmallestStepAndLeavesTheState) {
  Choosy stepper([](double time, double) { return time < 0.5; });
  StepController controller(stepper, {.largest = 0.5, .most_halvings = 5});
  State state{Positions::Zero(3, 1), Positions::Zero(3, 1), 0};
  state.v(0, 0) = 1;
  ASSERT_TRUE(controller.advance(state));
  const State before = state;
  const StepResult result = controller.advance(state);
  EXPECT_EQ(result.status, Status::not_converged);
  EXPECT_EQ(result.iterations, 7);
  EXPECT_STREQ(result.detail, "not to my taste");
  EXPECT_EQ(stepper.attempts.back(), 0.5 / 32);
  EXPECT_EQ(stepper.work().rejected_steps, 6);
  EXPECT_EQ(state.x, before.x);
  EXPECT_EQ(state.v, before.v);
  EXPECT_EQ(state.time, before.time);
}

}  // namespace
