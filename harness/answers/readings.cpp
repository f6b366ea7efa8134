// What known answers read off runs: distances, turns, swings, tensions, falls, angles and shadows.
#include <Eigen/Geometry>
#include <numbers>

#include "harness/answers/answer.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference.h"
#include "harness/scenes/meshes.h"

namespace harness {
namespace {

// RMS distance from the exact motion or the reference at the end of the run, over the size.
double distance_at_the_end(const AnswerScene& at, const Motion& motion) {
  if (at.type->exact)
    return rms_distance(at.scene, motion.state.x, at.type->exact(at.parameters, motion.state.time));
  const auto reference = ReferenceFolder::usual()->find(at.type->name, at.parameters);
  const bool known = reference && reference->known_until(headline_error) >= at.scene.duration;
  return known ? rms_distance(at.scene, motion.state.x, reference->positions.back()) : unknown;
}

// The angular velocity in the last step of a body centered on the origin, over the initial one.
double turning_rate_kept(const AnswerScene& at, const Motion& motion) {
  double cosine = 0, sine = 0;
  for (Eigen::Index i = 0; i < motion.state.x.cols(); ++i) {
    const Eigen::Vector3d a = motion.before.x.col(i), b = motion.state.x.col(i);
    cosine += a.dot(b);
    sine += a.cross(b).norm();
  }
  const double start_rate = 2 * std::numbers::pi * at.parameters.at("turns");
  return std::atan2(sine, cosine) / motion.step / start_rate;
}

// ---- The swing of a chain's free end ----

struct Swing {
  std::vector<double> crossings, peaks;  // of the vertical, s; of whole half-oscillations, m
};

Swing swing_of(const Motion& motion) {
  const double h = motion.step;
  Swing found;
  double peak = 0, before_last = 0;
  for (std::size_t i = 1; i < motion.free_end.size(); ++i) {
    const double was = motion.free_end[i - 1].x(), is = motion.free_end[i].x();
    if (was * is <= 0 && was != 0) {
      found.crossings.push_back(motion.times[i] - h + h * was / (was - is));
      if (found.crossings.size() > 1) found.peaks.push_back(peak);
      peak = 0;
    }
    // The peak of the parabola through three positions whose middle one is the largest.
    const double a = std::abs(before_last), b = std::abs(was), c = std::abs(is);
    if (b >= a && b >= c && 2 * b > a + c)
      peak = std::max(peak, b + (c - a) * (c - a) / (8 * (2 * b - a - c)));
    before_last = was;
  }
  return found;
}

// A swinging chain's frequency, rad/s.
double swing_frequency(const AnswerScene& /*at*/, const Motion& motion) {
  const std::vector<double> seen = swing_of(motion).crossings;
  if (seen.size() < 3) return unknown;
  return std::numbers::pi * static_cast<double>(seen.size() - 1) / (seen.back() - seen.front());
}

// The part of its amplitude that is left after a period.
double swing_kept(const AnswerScene& /*at*/, const Motion& motion) {
  const std::vector<double> seen = swing_of(motion).peaks;
  if (seen.size() < 3) return unknown;
  return std::pow(seen.back() / seen.front(), 2 / static_cast<double>(seen.size() - 1));
}

// The largest deviation of a link's tension from the catenary's, over the largest tension there.
double catenary_tensions(const AnswerScene& at, const Motion& motion) {
  const Positions& x = at.scene.start.x;
  const Problem& problem = *at.scene.problem;
  const auto n = static_cast<int>(x.cols());
  const double weight = problem.mass()[0] * problem.gravity().norm();
  const auto vertical = [=](int k) { return weight * (k + 1 - 0.5 * n); };  // N, of link k
  double horizontal = 0;                                                    // N, the same for all
  for (int k = 0; k + 1 < n; ++k) {
    const Eigen::Vector3d link = (x.col(k + 1) - x.col(k)).normalized();
    if (vertical(k) != 0) horizontal = vertical(k) * link.x() / link.y();
  }
  if (motion.pulls.empty()) return unknown;
  double worst = 0, largest = 0;
  for (int k = 0; k + 1 < n; ++k) {
    const double exact = std::hypot(horizontal, vertical(k)),
                 pull = motion.pulls[static_cast<std::size_t>(k)];
    worst = std::max(worst, std::abs(pull / (motion.step * motion.step) - exact));
    largest = std::max(largest, exact);
  }
  return worst / largest;
}

// ---- When the free end of a folded chain has come so far, by where it was at steps' ends ----

struct Passing {
  double time = unknown, speed = unknown;
};

Passing passing_of(const AnswerScene& at, const Motion& motion) {
  const double start = at.scene.start.x(1, at.scene.start.x.cols() - 1), h = motion.step,
               goal = folded_part * at.parameters.at("length");
  const auto moved = [&](std::size_t i) { return start - motion.free_end[i].y(); };
  for (std::size_t i = 1; i < motion.free_end.size(); ++i) {
    const double was = moved(i - 1), is = moved(i);
    if (was >= goal || is < goal) continue;
    // Speeds are those of the middles of steps.
    const double within = (goal - was) / (is - was), speed = (is - was) / h,
                 last_speed = i > 1 ? (was - moved(i - 2)) / h : speed;
    return {motion.times[i] - h * (1 - within), speed + (within - 0.5) * (speed - last_speed)};
  }
  return {};
}

// The time in which the free end of a folded chain moves by folded_part of the length.
double folded_time(const AnswerScene& at, const Motion& motion) {
  return passing_of(at, motion).time;
}
// Its speed at that time over the initial one.
double folded_speed(const AnswerScene& at, const Motion& motion) {
  return passing_of(at, motion).speed / at.parameters.at("speed");
}

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

// RMS deviation of the angle between warp and weft from that of a net on a sphere, in degrees, over
// the cells whose four corners lie on the ball at the end.
double net_angle_deviation(const AnswerScene& at, const Motion& motion) {
  constexpr double near = 1.002;  // of the radius
  const Positions& x = motion.state.x;
  const int n = static_cast<int>(at.parameters.at("n"));
  const double radius = at.parameters.at("radius"), link = square_link(at.parameters);
  double squares = 0;
  int cells = 0;
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const double u = (j + 1 - 0.5 * n) * link, v = (i + 1 - 0.5 * n) * link;
      const double z = u * v / (radius * radius);
      const Eigen::Vector3d a = x.col(i * n + j), b = x.col(i * n + j + 1),
                            c = x.col((i + 1) * n + j), d = x.col((i + 1) * n + j + 1);
      const double farthest = std::max({a.norm(), b.norm(), c.norm(), d.norm()});
      if (!(farthest <= near * radius) || std::abs(z) > locked) continue;
      // Between warp and weft in the middle of the cell.
      const Eigen::Vector3d weft = b - a + d - c, warp = c - a + d - b;
      const double w = std::atan2(weft.cross(warp).norm(), weft.dot(warp));
      const double beyond = z < 0 ? std::numbers::pi - w : w;
      squares += std::pow(beyond - net_angle(std::abs(z)), 2);
      ++cells;
    }
  return cells ? std::sqrt(squares / cells) * 180 / std::numbers::pi : std::nan("");
}

// Cusick's drape coefficient (BS 5058, ISO 9073-9), %: how much of the ring the shadow covers.
double drape_coefficient(const AnswerScene& at, const Motion& motion) {
  const double reach = 1.1 * at.parameters.at("radius"),
               table = std::numbers::pi * std::pow(at.parameters.at("table"), 2);
  const auto shadow = [&](const Positions& x) { return shadow_area(at.scene, x, reach, 880); };
  Positions flat = at.scene.start.x;
  flat.row(1).setZero();
  return 100 * (shadow(motion.state.x) - table) / (shadow(flat) - table);
}

const std::map<std::string, Reading*> readings{{"distance_at_the_end", distance_at_the_end},
                                               {"turning_rate_kept", turning_rate_kept},
                                               {"swing_frequency", swing_frequency},
                                               {"swing_kept", swing_kept},
                                               {"catenary_tensions", catenary_tensions},
                                               {"folded_time", folded_time},
                                               {"folded_speed", folded_speed},
                                               {"net_angle_deviation", net_angle_deviation},
                                               {"drape_coefficient", drape_coefficient}};

}  // namespace

Reading* reading_named(const std::string& name) { return readings.at(name); }

}  // namespace harness
