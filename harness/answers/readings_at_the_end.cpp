// Readings of the positions at the end of a run: distances, angles and shadows.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "harness/answers/readings.h"
#include "harness/judge/reference.h"
#include "harness/scenes/meshes.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::State;

class AtTheEnd final : public Reading {
 public:
  using Value = double(const AnswerScene&, const State& end);
  AtTheEnd(const AnswerScene& at, Value* of) : at_(at), value_(of) {}

  void after(const State& /*before*/, const State& state, double /*h*/) override { end_ = state; }
  double value() const override { return value_(at_, end_); }

 private:
  const AnswerScene& at_;
  Value* value_;
  State end_;
};

// ---- The fishnet on the sphere: what the drape's yarns must do where they lie on the ball ----
//
// A net of inextensible yarns on a sphere of radius R, two of which cross at right angles on
// great circles (here by the scene's mirror symmetry), is a Chebyshev net (Chebyshev 1878; Mack and
// Taylor 1956, "The fitting of woven cloth to surfaces"): the angle w between warp and weft has
// w_uv = -sin(w) / R^2 over the yarn lengths u and v from the crossing, hence depends on z = u v
// / R^2 alone:
//   z w'' + w' + sin(w) = 0,  w(0) = pi / 2,  w'(0) = -1.
// Forces, friction and steps have no part in it; strain has.

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

double angle_deviation(const AnswerScene& at, const State& end) {
  constexpr double near = 1.002;  // of the radius
  const int n = static_cast<int>(at.parameters.at("n"));
  const double radius = at.parameters.at("radius"), link = square_link(at.parameters);
  double squares = 0;
  int cells = 0;
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      const double u = (j + 1 - 0.5 * n) * link, v = (i + 1 - 0.5 * n) * link;
      const double z = u * v / (radius * radius);
      const Eigen::Vector3d a = end.x.col(i * n + j), b = end.x.col(i * n + j + 1),
                            c = end.x.col((i + 1) * n + j), d = end.x.col((i + 1) * n + j + 1);
      const double farthest = std::max({a.norm(), b.norm(), c.norm(), d.norm()});
      if (!(farthest <= near * radius) || std::abs(z) > locked) continue;
      // Between warp and weft in the middle of the cell.
      const Eigen::Vector3d weft = b - a + d - c, warp = c - a + d - b;
      const double w = std::atan2(weft.cross(warp).norm(), weft.dot(warp));
      const double beyond = z < 0 ? std::numbers::pi - w : w;
      squares += std::pow(beyond - net_angle(std::abs(z)), 2);
      ++cells;
    }
  }
  return cells ? std::sqrt(squares / cells) * 180 / std::numbers::pi : std::nan("");
}

// ---- The drape coefficient ----

// m^2, of all triangles seen from above, what lies over one another once: counted on a grid of
// cells of `cell` m.
double shadow(const Positions& x, const std::vector<std::array<int, 3>>& triangles, double cell) {
  const double left = x.row(0).minCoeff(), front = x.row(2).minCoeff();
  const auto columns = static_cast<int>((x.row(0).maxCoeff() - left) / cell) + 2;
  const auto rows = static_cast<int>((x.row(2).maxCoeff() - front) / cell) + 2;
  std::vector<char> covered(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector2d p(x(0, a) - left, x(2, a) - front), q(x(0, b) - left, x(2, b) - front),
        r(x(0, c) - left, x(2, c) - front);
    const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                         const Eigen::Vector2d& at) {
      return (to.x() - from.x()) * (at.y() - from.y()) - (to.y() - from.y()) * (at.x() - from.x());
    };
    const auto first = [&](double low) { return std::max(0, static_cast<int>(low / cell)); };
    for (int i = first(std::min({p.y(), q.y(), r.y()}));
         (i + 0.5) * cell <= std::max({p.y(), q.y(), r.y()}); ++i) {
      for (int j = first(std::min({p.x(), q.x(), r.x()}));
           (j + 0.5) * cell <= std::max({p.x(), q.x(), r.x()}); ++j) {
        const Eigen::Vector2d middle((j + 0.5) * cell, (i + 0.5) * cell);
        const double u = side(p, q, middle), v = side(q, r, middle), w = side(r, p, middle);
        if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))
          covered[static_cast<std::size_t>(i * columns + j)] = 1;
      }
    }
  }
  return cell * cell * static_cast<double>(std::count(covered.begin(), covered.end(), 1));
}

double coefficient(const AnswerScene& at, const State& end) {
  const double cell = at.parameters.at("radius") / 400,
               table = std::numbers::pi * std::pow(at.parameters.at("table"), 2);
  Positions flat = at.scene.start.x;
  flat.row(1).setZero();
  return 100 * (shadow(end.x, at.scene.triangles, cell) - table) /
         (shadow(flat, at.scene.triangles, cell) - table);
}

double distance(const AnswerScene& at, const State& end) {
  return rms_distance(at.scene, end.x, at.type->exact(at.parameters, end.time));
}

}  // namespace

std::unique_ptr<Reading> distance_at_the_end(const AnswerScene& at) {
  return std::make_unique<AtTheEnd>(at, distance);
}
std::unique_ptr<Reading> net_angle_deviation(const AnswerScene& at) {
  return std::make_unique<AtTheEnd>(at, angle_deviation);
}
std::unique_ptr<Reading> drape_coefficient(const AnswerScene& at) {
  return std::make_unique<AtTheEnd>(at, coefficient);
}

}  // namespace harness
