#include "harness/judge/mechanics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "harness/base/text.h"
#include "solvers/problem/forces.h"

namespace harness {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

StrainRange strain_range(const Problem& problem, const Positions& x) {
  double low = 1, high = 1;  // |d|^2 / l^2: one root for all edges instead of one each
  std::size_t shortest = 0, longest = 0;
  const std::vector<double>& scale = problem.limit_scale();
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    const double l = problem.rest_length()[k];
    double q = (x.col(b) - x.col(a)).squaredNorm() / (l * l);
    if (!std::isfinite(q)) return {infinity, infinity, k};
    if (!scale.empty()) q = std::pow(1 + (std::sqrt(q) - 1) / scale[k], 2);
    if (q < low) {
      low = q;
      shortest = k;
    }
    if (q > high) {
      high = q;
      longest = k;
    }
  }
  const double stretch = std::sqrt(high) - 1, squeeze = 1 - std::sqrt(low);
  return {std::max(stretch, squeeze), stretch, stretch >= squeeze ? longest : shortest};
}

void append_strains(const Problem& problem, const Positions& x, std::vector<double>& strains) {
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    strains.push_back(std::abs((x.col(b) - x.col(a)).norm() / problem.rest_length()[k] - 1));
    if (!problem.limit_scale().empty()) strains.back() /= problem.limit_scale()[k];
  }
}

Eigen::Vector3d linear_momentum(const Problem& problem, const Positions& v) {
  return v * Eigen::Map<const Eigen::VectorXd>(problem.mass().data(), problem.vertices());
}

Eigen::Vector3d angular_momentum(const Problem& problem, const State& state) {
  // Masses times positions: the first moment.
  const Eigen::Vector3d centre = linear_momentum(problem, state.x) / problem.total_mass();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    const Eigen::Vector3d arm = state.x.col(i) - centre, velocity = state.v.col(i);
    sum += problem.mass()[i] * arm.cross(velocity);
  }
  return sum;
}

double total_energy(const Problem& problem, const State& state) {
  return inextensible::potential_energy(problem, state.x) +
         inextensible::kinetic_energy(problem, state.v);
}

double energy_scale(const Scene& scene) {
  const Problem& problem = *scene.problem;
  return problem.total_mass() * problem.gravity().norm() * scene.size +
         inextensible::kinetic_energy(problem, scene.start.v);
}

void raise(double& figure, double value) {
  figure = std::isnan(figure) ? value : std::max(figure, value);
}

double shadow_area(const Scene& scene, const Positions& x, double reach, int pixels) {
  const double pixel = 2 * reach / pixels;
  std::vector<char> dark(pixels * pixels, 0);
  const auto index = [&](double coordinate) {
    return std::clamp(static_cast<int>((coordinate + reach) / pixel), 0, pixels - 1);
  };
  for (const auto& [a, b, c] : scene.triangles) {
    const Eigen::Vector2d p(x(0, a), x(2, a)), q(x(0, b), x(2, b)), r(x(0, c), x(2, c));
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    const double area = cross(q - p, r - p);
    if (area == 0) continue;
    const Eigen::Vector2d low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
    for (int j = index(low.y()); j <= index(high.y()); ++j) {
      for (int i = index(low.x()); i <= index(high.x()); ++i) {
        const Eigen::Vector2d s((i + 0.5) * pixel - reach, (j + 0.5) * pixel - reach);
        if (cross(q - p, s - p) / area >= 0 && cross(r - q, s - q) / area >= 0 &&
            cross(p - r, s - r) / area >= 0)
          dark[j * pixels + i] = 1;
      }
    }
  }
  const auto count = std::count(dark.begin(), dark.end(), 1);
  return static_cast<double>(count) * pixel * pixel;
}

bool energy_can_only_fall(const Problem& problem) {
  return (problem.collider() || problem.has_drag()) && !problem.body_motion();
}

EnergyRecord::EnergyRecord(const Scene& scene, Velocities velocities)
    : problem_(*scene.problem), velocities_(velocities) {
  begin(scene.start, energy_scale(scene));
}

void EnergyRecord::begin(const State& state, double scale) {
  scale_ = scale;
  start_ = total_energy(problem_, state);
  before_ = last_ = {};
  window_ = {};
}

std::optional<double> EnergyRecord::after(const State& state, double h) {
  before_ = last_;
  last_ = {before_.step + 1, state.time, h, inextensible::potential_energy(problem_, state.x),
           inextensible::kinetic_energy(problem_, state.v)};
  if (velocities_ == Velocities::whole_step) return settle(last_, last_.kinetic);
  if (before_.step == 0) return {};
  return settle(before_, (h * before_.kinetic + before_.h * last_.kinetic) / (h + before_.h));
}

// No velocity follows the last step: its own, or what the last two foretell if that is less.
std::optional<double> EnergyRecord::finish() {
  if (velocities_ == Velocities::whole_step || last_.step == 0) return {};
  double kinetic = last_.kinetic;
  if (before_.step > 0)
    kinetic += std::min(0.0, (last_.kinetic - before_.kinetic) * last_.h / (last_.h + before_.h));
  return settle(last_, kinetic);
}

double EnergyRecord::settle(const Instant& at, double kinetic) {
  const double gain = (at.potential + kinetic - start_) / scale_;
  if (!(gain <= gain_)) {  // unknown at first
    gain_ = gain;
    gain_time_ = at.time;
    gain_step_ = at.step;
  }
  raise(drift_, std::abs(gain));
  constexpr double window_length = 0.01;  // s
  window_.sum += gain * at.h;
  window_.length += at.h;
  if (window_.length >= window_length * (1 - 1e-9)) {
    const double mean = window_.sum / window_.length;
    rise_ += std::max(0.0, mean - window_.before);
    window_ = {0, 0, mean};
  }
  return gain;
}

std::string energy_gained(const EnergyRecord& energy, double bound, double seconds) {
  if (energy.gain() > bound)
    return concat("energy ", number_text(energy.gain(), 3), " of weight times size above the ",
                  "start's at step ", energy.gain_step(), " (t = ", energy.gain_time(),
                  " s), permitted are ", bound);
  const double in_all = bound * std::max(1.0, seconds);
  if (energy_can_only_fall(energy.problem()) && energy.rise() > in_all)
    return concat("energy rose by ", number_text(energy.rise(), 3), " of weight times size in all,",
                  " where it can only fall; permitted are ", in_all);
  return "";
}

}  // namespace harness
