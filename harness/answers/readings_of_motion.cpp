// Readings that look at every step: turns, swings, tensions and falls.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/answers/readings.h"
#include "solvers/problem/edge_constraints.h"

namespace harness {
namespace {

using inextensible::State;

class TurningRate final : public Reading {
 public:
  explicit TurningRate(double start_rate) : start_rate_(start_rate) {}

  void after(const State& before, const State& state, double h) override {
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

// The free end's deflection: when it crosses the vertical, and how far it swings between.
class Swing final : public Reading {
 public:
  explicit Swing(bool of_frequency) : of_frequency_(of_frequency) {}

  void after(const State& before, const State& state, double h) override {
    const Eigen::Index end = state.x.cols() - 1;
    const double was = before.x(0, end), is = state.x(0, end);
    if (was * is <= 0 && was != 0) {
      crossings_.push_back(state.time - h + h * was / (was - is));
      if (crossings_.size() > 1) peaks_.push_back(peak_);
      peak_ = 0;
    }
    // The peak of the parabola through three positions whose middle one is the largest.
    const double a = std::abs(before_last_), b = std::abs(was), c = std::abs(is);
    if (b >= a && b >= c && 2 * b > a + c)
      peak_ = std::max(peak_, b + (c - a) * (c - a) / (8 * (2 * b - a - c)));
    before_last_ = was;
  }

  double value() const override {
    const std::vector<double>& seen = of_frequency_ ? crossings_ : peaks_;
    if (seen.size() < 3) return std::nan("");
    const auto halves = static_cast<double>(seen.size() - 1);
    return of_frequency_ ? std::numbers::pi * halves / (seen.back() - seen.front())
                         : std::pow(seen.back() / seen.front(), 2 / halves);
  }

 private:
  bool of_frequency_;
  std::vector<double> crossings_, peaks_;  // s; m, of whole half-oscillations
  double peak_ = 0, before_last_ = 0;
};

// The pull of edge k on its ends is lambda_k times the gradient of its constraint.
class Tensions final : public Reading, public inextensible::IterateObserver {
 public:
  explicit Tensions(const AnswerScene& at) {
    const inextensible::Positions& x = at.scene.start.x;
    const inextensible::Problem& problem = *at.scene.problem;
    const auto n = static_cast<int>(x.cols());
    const double weight = problem.mass()[0] * problem.gravity().norm();
    double horizontal = 0;  // N
    for (int k = 0; k + 1 < n; ++k) {
      const Eigen::Vector3d link = (x.col(k + 1) - x.col(k)).normalized();
      const double vertical = weight * (k + 1 - 0.5 * n);
      if (vertical != 0) horizontal = vertical * link.x() / link.y();  // the same for all
    }
    gradient_.resize(3, problem.constraints());
    for (int k = 0; k + 1 < n; ++k)
      exact_.push_back(std::hypot(horizontal, weight * (k + 1 - 0.5 * n)));
  }

  void iterate(const inextensible::EdgeConstraints& edges, int /*j*/,
               const inextensible::Positions& x, const Eigen::VectorXd& multipliers) override {
    edges.gradient(x, gradient_);
    pull_.assign(exact_.size(), 0);
    for (int k = 0; k < edges.count(); ++k)
      pull_[static_cast<std::size_t>(edges.problem_edge(k))] =
          multipliers(k) * gradient_.col(k).norm();
  }
  void after(const State& /*before*/, const State& /*state*/, double h) override {
    if (pull_.empty()) return;
    double worst = 0;
    for (std::size_t k = 0; k < exact_.size(); ++k)
      worst = std::max(worst, std::abs(pull_[k] / (h * h) - exact_[k]));
    deviation_ = worst / *std::max_element(exact_.begin(), exact_.end());
  }
  double value() const override { return deviation_; }
  IterateObserver* observer() override { return this; }

 private:
  std::vector<double> exact_;  // N, of each edge of the problem
  std::vector<double> pull_;   // N s^2
  Eigen::Matrix3Xd gradient_;
  double deviation_ = std::nan("");
};

// When the free end has come so far, by what it had moved at the ends of steps.
class FreeEnd final : public Reading {
 public:
  // start_speed: what its speed there is divided by; 0: its time is read.
  FreeEnd(const AnswerScene& at, double start_speed)
      : start_(at.scene.start.x(1, at.scene.start.x.cols() - 1)),
        goal_(folded_part * at.parameters.at("length")),
        start_speed_(start_speed) {}

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
  double value() const override { return start_speed_ > 0 ? speed_ / start_speed_ : time_; }

 private:
  double start_, goal_, start_speed_;
  double time_ = std::nan(""), speed_ = std::nan(""), last_speed_ = std::nan("");
};

}  // namespace

std::unique_ptr<Reading> turning_rate_kept(const AnswerScene& at) {
  return std::make_unique<TurningRate>(2 * std::numbers::pi * at.parameters.at("turns"));
}
std::unique_ptr<Reading> swing_frequency(const AnswerScene& /*at*/) {
  return std::make_unique<Swing>(true);
}
std::unique_ptr<Reading> swing_kept(const AnswerScene& /*at*/) {
  return std::make_unique<Swing>(false);
}
std::unique_ptr<Reading> catenary_tensions(const AnswerScene& at) {
  return std::make_unique<Tensions>(at);
}
std::unique_ptr<Reading> folded_time(const AnswerScene& at) {
  return std::make_unique<FreeEnd>(at, 0);
}
std::unique_ptr<Reading> folded_speed(const AnswerScene& at) {
  return std::make_unique<FreeEnd>(at, at.parameters.at("speed"));
}

}  // namespace harness
