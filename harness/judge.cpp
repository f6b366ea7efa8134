#include "judge.h"

#include <algorithm>
#include <cmath>

#include "forces.h"

namespace harness {

using inextensible::Positions;
using inextensible::State;

Judge::Judge(const Scene& scene, int sample_every)
    : scene_(scene), sample_every_(std::max(1, sample_every)) {
  const auto& problem = *scene.problem;
  start_energy_ = inextensible::potential_energy(problem, scene.start.x) +
                  inextensible::kinetic_energy(problem, scene.start.v);
  double mass = 0;
  for (const double m : problem.mass()) mass += m;
  energy_scale_ = mass * problem.gravity().norm() * scene.size;
}

Judge::Range Judge::strain_range(const Positions& x) const {
  const auto& edges = scene_.problem->edges();
  const auto& rest = scene_.problem->rest_length();
  double low = 1, high = 1;  // of |d|^2 / l^2
  bool finite = true;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double q = (x.col(edges[k].b) - x.col(edges[k].a)).squaredNorm() / (rest[k] * rest[k]);
    finite = finite && std::isfinite(q);
    low = std::min(low, q);
    high = std::max(high, q);
  }
  if (!finite)
    return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const double stretch = std::sqrt(high) - 1;
  return {std::max(stretch, 1 - std::sqrt(low)), stretch};
}

double Judge::look(const Positions& filtered, const State& state) {
  const Range range = strain_range(filtered);
  running_.max_strain = std::max(running_.max_strain, range.most);
  running_.max_stretch = std::max(running_.max_stretch, range.stretch);
  if (scene_.problem->collider()) {
    const double after = strain_range(state.x).most;
    const double before = running_.max_strain_after_collision;
    running_.max_strain_after_collision = std::isnan(before) ? after : std::max(before, after);
  }
  if (++steps_ % sample_every_ == 0) sample(filtered, state);
  return range.most;
}

void Judge::sample(const Positions& filtered, const State& state) {
  const auto& problem = *scene_.problem;
  const auto& edges = problem.edges();
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double length = (filtered.col(edges[k].b) - filtered.col(edges[k].a)).norm();
    strains_.push_back(std::abs(length / problem.rest_length()[k] - 1));
  }
  const double kinetic = inextensible::kinetic_energy(problem, state.v);
  kinetic_sum_ += kinetic;
  ++samples_;
  const auto raise = [](double& figure, double value) {
    figure = std::isnan(figure) ? value : std::max(figure, value);
  };
  if (scene_.conserves_energy) {
    const double energy = kinetic + inextensible::potential_energy(problem, state.x);
    raise(running_.energy_drift, std::abs(energy - start_energy_) / energy_scale_);
  }
  for (const auto& mirror : scene_.mirrors) {
    const Eigen::Matrix3d reflect =
        Eigen::Matrix3d::Identity() - 2 * mirror.normal * mirror.normal.transpose();
    double worst = 0;
    for (Eigen::Index v = 0; v < state.x.cols(); ++v) {
      const auto image = mirror.image[static_cast<std::size_t>(v)];
      worst = std::max(worst, (reflect * state.x.col(v) - state.x.col(image)).squaredNorm());
    }
    raise(running_.symmetry_defect, std::sqrt(worst) / scene_.size);
  }
}

Verdict Judge::verdict() const {
  Verdict verdict = running_;
  if (samples_ > 0) {
    verdict.kinetic_energy_mean = kinetic_sum_ / samples_;
    double squares = 0;
    for (const double strain : strains_) squares += strain * strain;
    verdict.rms_strain = std::sqrt(squares / static_cast<double>(strains_.size()));
    verdict.p99_strain = quantile(strains_, 0.99);
  }
  return verdict;
}

}  // namespace harness
