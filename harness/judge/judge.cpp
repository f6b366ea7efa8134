#include "harness/judge/judge.h"

#include <algorithm>
#include <cmath>

#include "harness/judge/measures.h"
#include "inextensible/problem/forces.h"

namespace harness {

using inextensible::Positions;
using inextensible::State;

namespace {

constexpr double time_tolerance = 1e-9;  // s; states add up their steps

}  // namespace

Judge::Judge(const Scene& scene, const Options& options) : scene_(scene), options_(options) {
  options_.sample_every = std::max(1, options_.sample_every);
  if (options_.residual) probe_.emplace();
  start_energy_ = total_energy(*scene.problem, scene.start);
  energy_scale_ = energy_scale(scene);
}

void Judge::before(const State& state, double h) {
  if (probe_ && (steps_ + 1) % options_.sample_every == 0) probe_->watch();
  // A sample in the middle of a step is interpolated.
  if (options_.reference && next_ < options_.reference->times.size() &&
      options_.reference->times[next_] < state.time + h - time_tolerance) {
    start_ = state;
  }
}

// Distances to the reference at the samples that the last step has reached.
void Judge::compare(const State& state) {
  const Reference& reference = *options_.reference;
  for (; next_ < reference.times.size() && reference.times[next_] <= state.time + time_tolerance;
       ++next_) {
    const double time = reference.times[next_];
    const bool inside = time < state.time - time_tolerance;
    const double part = inside ? (time - start_.time) / (state.time - start_.time) : 1;
    const Positions x = inside ? Positions((1 - part) * start_.x + part * state.x) : state.x;
    if (next_ < reference.positions.size()) {
      squares_ += std::pow(rms_distance(scene_, x, reference.positions[next_]), 2);
      most_ = std::max(most_, max_distance(scene_, x, reference.positions[next_]));
      gap_squares_ += std::pow(reference.gap[next_], 2);
      ++compared_;
    } else {
      const ShapeStatistics shape = shape_statistics(scene_, x);
      const ShapeStatistics& wanted = reference.shape[next_];
      shape_squares_.potential_energy +=
          std::pow(shape.potential_energy - wanted.potential_energy, 2);
      shape_squares_.corner_height += std::pow(shape.corner_height - wanted.corner_height, 2);
      shape_squares_.shadow += std::pow(shape.shadow - wanted.shadow, 2);
      ++shapes_;
    }
  }
}

double Judge::after(const Positions& filtered, const State& state, bool counts) {
  const StrainRange range = strain_range(*scene_.problem, filtered);
  running_.max_strain = std::max(running_.max_strain, range.most);
  running_.max_stretch = std::max(running_.max_stretch, range.stretch);
  if (scene_.problem->collider()) {
    const double after = strain_range(*scene_.problem, state.x).most;
    const double before = running_.max_strain_after_collision;
    running_.max_strain_after_collision = std::isnan(before) ? after : std::max(before, after);
  }
  if (counts && ++steps_ % options_.sample_every == 0) {
    sample(filtered, state);
    if (const auto residuals = probe_ ? probe_->residuals() : std::nullopt)
      running_.residuals.push_back({state.time, residuals->first, residuals->last});
  }
  if (options_.reference) compare(state);
  return range.most;
}

void Judge::sample(const Positions& filtered, const State& state) {
  const auto& problem = *scene_.problem;
  append_strains(problem, filtered, strains_);
  const double kinetic = inextensible::kinetic_energy(problem, state.v);
  kinetic_sum_ += kinetic;
  ++samples_;
  if (scene_.conserves_energy) {
    const double energy = kinetic + inextensible::potential_energy(problem, state.x);
    raise(running_.energy_drift, std::abs(energy - start_energy_) / energy_scale_);
  }
  for (const auto& mirror : scene_.mirrors) {
    const Eigen::Matrix3d reflect =
        Eigen::Matrix3d::Identity() - 2 * mirror.normal * mirror.normal.transpose();
    double worst = 0;
    for (Eigen::Index v = 0; v < state.x.cols(); ++v) {
      const auto image = mirror.image[v];
      worst = std::max(worst, (reflect * state.x.col(v) - state.x.col(image)).squaredNorm());
    }
    raise(running_.symmetry_defect, std::sqrt(worst) / scene_.size);
  }
}

Measures Judge::measures() const {
  Measures measures = running_;
  if (samples_ > 0) {
    measures.kinetic_energy_mean = kinetic_sum_ / samples_;
    double squares = 0;
    for (const double strain : strains_) squares += strain * strain;
    measures.rms_strain = std::sqrt(squares / static_cast<double>(strains_.size()));
    measures.p99_strain = quantile(strains_, 0.99);
  }
  if (!measures.residuals.empty()) {
    const auto count = static_cast<double>(measures.residuals.size());
    measures.residual_first = measures.residual_last = 0;
    for (const auto& residual : measures.residuals) {
      measures.residual_first += residual.first / count;
      measures.residual_last += residual.last / count;
    }
    if (!options_.residual_series) measures.residuals.clear();
  }
  if (!options_.reference) return measures;
  measures.reference = reference_name(options_.reference->scene, options_.reference->parameters);
  measures.valid_until = options_.reference->valid_until;
  if (compared_ > 0) {
    measures.trajectory = std::sqrt(squares_ / compared_);
    measures.trajectory_max = most_;
    measures.gap = std::sqrt(gap_squares_ / compared_);
  }
  if (shapes_ > 0) {
    measures.shape_potential_energy = std::sqrt(shape_squares_.potential_energy / shapes_);
    measures.shape_corner_height = std::sqrt(shape_squares_.corner_height / shapes_);
    measures.shape_shadow = std::sqrt(shape_squares_.shadow / shapes_);
  }
  return measures;
}

}  // namespace harness
