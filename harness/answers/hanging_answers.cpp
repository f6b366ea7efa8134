// What hangs: the frequency and the damping of small oscillations, a catenary that stays and its
// tensions, and a chain that whirls.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/answers/readings.h"
#include "harness/scenes/hanging_scenes.h"
#include "harness/scenes/meshes.h"
#include "solvers/problem/edge_constraints.h"

namespace harness {
namespace {

using inextensible::State;

// The free end's deflection: when it crosses the vertical, and how far it swings between.
class Swing : public Reading {
 public:
  void after(const State& before, const State& state, double h) override {
    const Eigen::Index end = state.x.cols() - 1;
    const double was = before.x(0, end), is = state.x(0, end);
    if (was * is <= 0 && was != 0) {
      crossings_.push_back(state.time - h + h * was / (was - is));
      if (crossings_.size() > 1) peaks_.push_back(peak_);
      peak_ = 0;
    }
    raise_peak(was, is);
  }

 protected:
  // Records the peak of the parabola through three positions whose middle one is the largest.
  void raise_peak(double was, double is) {
    const double a = std::abs(before_last_), b = std::abs(was), c = std::abs(is);
    if (b >= a && b >= c && 2 * b > a + c)
      peak_ = std::max(peak_, b + (c - a) * (c - a) / (8 * (2 * b - a - c)));
    before_last_ = was;
  }

  std::vector<double> crossings_, peaks_;  // s; m, of whole half-oscillations
  double peak_ = 0, before_last_ = 0;
};

double frequency_of(const AnswerScene& at) {
  return hanging_frequency(static_cast<int>(at.parameters.at("n")) - 1, row_link(at.parameters),
                           at.parameters.at("gravity"), static_cast<int>(at.parameters.at("mode")));
}

class Frequency final : public Swing {
 public:
  double value() const override {
    if (crossings_.size() < 3) return std::nan("");
    const auto halves = static_cast<double>(crossings_.size() - 1);
    return std::numbers::pi * halves / (crossings_.back() - crossings_.front());
  }
};

class AmplitudeKept final : public Swing {
 public:
  double value() const override {
    if (peaks_.size() < 3) return std::nan("");
    const auto halves = static_cast<double>(peaks_.size() - 1);
    return std::pow(peaks_.back() / peaks_.front(), 2 / halves);
  }
};

// The largest deviation of a link's tension from the catenary's, over the largest tension there.
// The pull of edge k on its ends is lambda_k times the gradient of its constraint.
class Tensions final : public Reading, public inextensible::IterateObserver {
 public:
  explicit Tensions(const AnswerScene& at) {
    const inextensible::Positions& x = at.scene.start.x;
    const inextensible::Problem& problem = *at.scene.problem;
    const auto n = static_cast<int>(x.cols());
    const double weight = problem.mass()[0] * problem.gravity().norm();
    for (int k = 0; k + 1 < n; ++k) {
      const Eigen::Vector3d link = (x.col(k + 1) - x.col(k)).normalized();
      const double vertical = weight * (k + 1 - 0.5 * n);
      if (vertical != 0) horizontal_ = vertical * link.x() / link.y();  // the same for all
    }
    gradient_.resize(3, problem.constraints());
    for (int k = 0; k + 1 < n; ++k)
      exact_.push_back(std::hypot(horizontal_, weight * (k + 1 - 0.5 * n)));
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
  double horizontal_ = 0;      // N
  std::vector<double> exact_;  // N, of each edge of the problem
  std::vector<double> pull_;   // N s^2
  Eigen::Matrix3Xd gradient_;
  double deviation_ = std::nan("");
};

double none(const AnswerScene& /*at*/) { return 0; }
double whole_amplitude(const AnswerScene& /*at*/) { return 1; }

template <class Kind>
std::unique_ptr<Reading> made(const AnswerScene& /*at*/) {
  return std::make_unique<Kind>();
}
std::unique_ptr<Reading> tensions(const AnswerScene& at) { return std::make_unique<Tensions>(at); }

constexpr const char* laguerre =
    "omega_k^2 = (g / l) x_k, x_k the zeros of the Laguerre polynomial of as many links (for the "
    "limit of many Bernoulli 1733)";
constexpr const char* catenary =
    "link i of N has the slope m g (i - (N + 1) / 2) over the horizontal tension (Bernoulli, "
    "Huygens and Leibniz 1691 for the limit of many)";

}  // namespace

std::vector<KnownAnswer> hanging_answers() {
  const std::vector<double> steps{0.02, 0.01, 0.005, 0.0025};
  return {{"swing_frequency",
           "hanging_chain",
           {{"duration", 6}},
           "frequency of the slowest small oscillation, rad/s",
           laguerre,
           1e-7,
           steps,
           frequency_of,
           made<Frequency>},
          {"swing_kept",
           "hanging_chain",
           {{"duration", 6}},
           "part of its amplitude that an oscillation keeps in a period",
           "nothing dissipates",
           1e-7,
           steps,
           whole_amplitude,
           made<AmplitudeKept>},
          {"catenary_place",
           "catenary",
           {},
           "distance from its rest after one second, RMS over its length",
           catenary,
           1e-7,
           steps,
           none,
           distance_at_the_end},
          {"catenary_tensions",
           "catenary",
           {},
           "largest deviation of a multiplier from its link's tension, over the largest tension",
           catenary,
           1e-7,
           steps,
           none,
           tensions,
           true},
          {"whirl_place",
           "whirling_chain",
           {},
           "distance from its place after one second, RMS over its length",
           "a rigid rotation in which each link leads along the force on all below it (Kolodner "
           "1955)",
           1e-6,
           steps,
           none,
           distance_at_the_end}};
}

}  // namespace harness
