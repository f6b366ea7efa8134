// The falling folded chain and the whip: how fast the free end is.
#include <cmath>

#include "harness/answers/readings.h"
#include "harness/scenes/folded_scenes.h"

namespace harness {
namespace {

using inextensible::State;

// Where the links are few that still move, a chain of links is no continuum any more.
constexpr double part = 0.9;

// When the free end has come so far, by what it had moved at the ends of steps.
class FreeEnd : public Reading {
 public:
  explicit FreeEnd(const AnswerScene& at)
      : start_(at.scene.start.x(1, at.scene.start.x.cols() - 1)),
        goal_(part * at.parameters.at("length")) {}

  void after(const State& before, const State& state, double h) override {
    const Eigen::Index end = state.x.cols() - 1;
    const double was = start_ - before.x(1, end), is = start_ - state.x(1, end);
    const double speed = (is - was) / h;  // of the middle of the step
    if (was < goal_ && is >= goal_) {
      const double within = (goal_ - was) / (is - was);
      time_ = state.time - h * (1 - within);
      speed_ = speed + (std::isfinite(last_speed_) ? (within - 0.5) * (speed - last_speed_) : 0);
    }
    last_speed_ = speed;
  }

  bool done() const override { return std::isfinite(time_); }

 protected:
  double time_ = std::nan(""), speed_ = std::nan("");

 private:
  double start_, goal_, last_speed_ = std::nan("");
};

class TimeOfFall final : public FreeEnd {
 public:
  using FreeEnd::FreeEnd;
  double value() const override { return time_; }
};

class SpeedThere final : public FreeEnd {
 public:
  explicit SpeedThere(const AnswerScene& at)
      : FreeEnd(at), start_speed_(at.parameters.at("speed")) {}
  double value() const override { return speed_ / start_speed_; }

 private:
  double start_speed_;
};

template <class Kind>
std::unique_ptr<Reading> of_free_end(const AnswerScene& at) {
  return std::make_unique<Kind>(at);
}

}  // namespace

std::vector<KnownAnswer> folded_answers() {
  const std::vector<double> steps{0.0025, 0.00125, 0.000625, 0.0003125};
  return {
      {"fold_fall_time",
       "folded_chain",
       {{"duration", 0.6}},
       "time in which the free end falls 0.9 of the length, s",
       "v^2 = g L s (2 - s) / (1 - s) (Calkin and March 1989), 0.85 of free fall over the whole "
       "length; a chain of links follows to O(link / L)",
       1e-4,
       steps,
       [](const AnswerScene& at) {
         return folded_fall_time(part, at.parameters.at("length"), at.parameters.at("gravity"));
       },
       of_free_end<TimeOfFall>,
       false,
       true},
      {"whip_speed",
       "whip",
       {{"duration", 1.2}},
       "speed of the free end when it has gone 0.9 of the length, over the start's",
       "v = v_0 / sqrt(1 - s): the energy stays, what moves becomes less; a chain of "
       "links follows to O(link / L)",
       1e-4,
       steps,
       [](const AnswerScene& /*at*/) { return 1 / std::sqrt(1 - part); },
       of_free_end<SpeedThere>,
       false,
       true}};
}

}  // namespace harness
