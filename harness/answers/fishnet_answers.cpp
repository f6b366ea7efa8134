// The fishnet on the sphere: what the drape's yarns must do where they lie on the ball.
//
// A net of inextensible yarns on a sphere of radius R, two of which cross at right angles on
// great circles (here by the scene's mirror symmetry), is a Chebyshev net (Chebyshev 1878; Mack and
// Taylor 1956, "The fitting of woven cloth to surfaces"): the angle w between warp and weft has
// w_uv = -sin(w) / R^2 over the yarn lengths u and v from the crossing, hence depends on z = u v
// / R^2 alone:
//   z w'' + w' + sin(w) = 0,  w(0) = pi / 2,  w'(0) = -1.
// Forces, friction and steps have no part in it; strain has.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "harness/answers/readings.h"
#include "harness/scenes/meshes.h"

namespace harness {
namespace {

constexpr double locked = 1.86;  // z, just before w is 0 and the net locks

// w(z), rad, by the classical Runge-Kutta method from w = pi / 2 - z, which holds to third order.
double net_angle(double z) {
  constexpr double begin = 1e-4;
  if (z <= begin) return 0.5 * std::numbers::pi - z;
  const int steps = 50 + static_cast<int>(200 * z);
  const double h = (z - begin) / steps;
  Eigen::Vector2d w(0.5 * std::numbers::pi - begin, -1);  // w, w'
  const auto rates = [](double at, const Eigen::Vector2d& y) -> Eigen::Vector2d {
    return {y(1), -(y(1) + std::sin(y(0))) / at};
  };
  for (int i = 0; i < steps; ++i) {
    const double at = begin + i * h;
    const Eigen::Vector2d a = rates(at, w), b = rates(at + 0.5 * h, w + 0.5 * h * a),
                          c = rates(at + 0.5 * h, w + 0.5 * h * b), d = rates(at + h, w + h * c);
    w += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return w(0);
}

// The RMS deviation from w(z), in degrees, over the cells whose four corners lie on the ball at the
// end.
class NetAngle final : public Reading {
 public:
  explicit NetAngle(const AnswerScene& at)
      : n_(static_cast<int>(at.parameters.at("n"))),
        radius_(at.parameters.at("radius")),
        link_(square_link(at.parameters)) {}

  void after(const inextensible::State& /*before*/, const inextensible::State& state,
             double /*h*/) override {
    x_ = state.x;
  }

  double value() const override {
    double squares = 0;
    int cells = 0;
    for (int i = 0; i + 1 < n_; ++i) {
      for (int j = 0; j + 1 < n_; ++j) {
        const double u = (j + 1 - 0.5 * n_) * link_, v = (i + 1 - 0.5 * n_) * link_;
        const double z = u * v / (radius_ * radius_);
        if (!on_ball(i, j) || std::abs(z) > locked) continue;
        const double w = angle(i, j), beyond = z < 0 ? std::numbers::pi - w : w;
        squares += std::pow(beyond - net_angle(std::abs(z)), 2);
        ++cells;
      }
    }
    return cells ? std::sqrt(squares / cells) * 180 / std::numbers::pi : std::nan("");
  }

 private:
  Eigen::Vector3d at(int i, int j) const { return x_.col(i * n_ + j); }

  bool on_ball(int i, int j) const {
    constexpr double near = 1.002;  // of the radius
    for (const auto& [a, b] : {std::pair(i, j), {i, j + 1}, {i + 1, j}, {i + 1, j + 1}}) {
      if (!(at(a, b).norm() <= near * radius_)) return false;
    }
    return true;
  }

  // Between warp and weft in the middle of the cell.
  double angle(int i, int j) const {
    const Eigen::Vector3d weft = at(i, j + 1) - at(i, j) + at(i + 1, j + 1) - at(i + 1, j);
    const Eigen::Vector3d warp = at(i + 1, j) - at(i, j) + at(i + 1, j + 1) - at(i, j + 1);
    return std::atan2(weft.cross(warp).norm(), weft.dot(warp));
  }

  int n_;
  double radius_, link_;
  inextensible::Positions x_;
};

}  // namespace

std::vector<KnownAnswer> fishnet_answers() {
  return {{"fishnet",
           "drape",
           {{"n", 41}, {"subdivisions", 5}, {"duration", 0.3}},
           "deviation of the angle between warp and weft where the cloth lies on the ball, RMS, "
           "degrees",
           "w_uv = -sin(w) / R^2 (Chebyshev 1878, Mack and Taylor 1956)",
           1e-3,
           {0.01, 0.005, 0.0025, 0.00125},
           [](const AnswerScene& /*at*/) { return 0.0; },
           [](const AnswerScene& at) -> std::unique_ptr<Reading> {
             return std::make_unique<NetAngle>(at);
           },
           false,
           true}};
}

}  // namespace harness
