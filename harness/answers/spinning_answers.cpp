// What spins: its place, and the speed that it keeps.
//
// A method that brings free flight back along directions at the end of the step turns by the angle
// atan(sin a / (2 - cos a)) after one by the angle a, so that its rate falls as Omega(t) = Omega_0
// / sqrt(1 + 2 Omega_0^2 h t). One whose directions are of the start turns by equal angles. Both
// laws are tested to the last digits in tests/harness/scenes.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "harness/answers/readings.h"

namespace harness {
namespace {

// The angle of the last step over its duration, over the rate at the start.
class TurningRate final : public Reading {
 public:
  explicit TurningRate(const AnswerScene& at)
      : start_rate_(2 * std::numbers::pi * at.parameters.at("turns")) {}

  // The bodies are centred on the origin and stay so.
  void after(const inextensible::State& before, const inextensible::State& state,
             double h) override {
    double cosine = 0, sine = 0;
    for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
      const Eigen::Vector3d a = before.x.col(i), b = state.x.col(i);
      cosine += a.dot(b);
      sine += a.cross(b).norm();
    }
    rate_ = std::atan2(sine, cosine) / h;
  }
  double value() const override { return rate_ / start_rate_; }

 private:
  double start_rate_, rate_ = std::nan("");
};

double nothing(const AnswerScene& /*at*/) { return 0; }
double all_of_it(const AnswerScene& /*at*/) { return 1; }

std::unique_ptr<Reading> turning_rate_kept(const AnswerScene& at) {
  return std::make_unique<TurningRate>(at);
}

constexpr const char* rigid =
    "a rigid rotation about the middle, held by tensions m Omega^2 times the distances of all that "
    "is farther out (Newton)";
constexpr const char* damping =
    "nothing slows it; by theory a method with directions of the end of the step keeps 1 / sqrt(1 "
    "+ 2 "
    "Omega_0^2 h t)";

}  // namespace

std::vector<KnownAnswer> spinning_answers() {
  const std::vector<double> steps{0.01, 0.005, 0.0025, 0.00125};
  std::vector<KnownAnswer> all;
  const struct {
    const char *place, *rate, *scene;
    SceneParameters given;
  } bodies[] = {{"net_place", "net_rate", "spinning_net", {{"n", 11}}},
                {"baton_place", "baton_rate", "baton", {}},
                {"hoop_place", "hoop_rate", "hoop", {}}};
  for (const auto& body : bodies) {
    all.push_back({body.place, body.scene, body.given,
                   "distance from its place after one turn, RMS over its size", rigid, 1e-6, steps,
                   nothing, distance_at_the_end});
    all.push_back({body.rate, body.scene, body.given,
                   "rate of turning after one second over the start's", damping, 1e-6, steps,
                   all_of_it, turning_rate_kept});
  }
  return all;
}

}  // namespace harness
