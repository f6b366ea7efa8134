#include "harness/judge/shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "harness/judge/mechanics.h"
#include "solvers/problem/forces.h"

namespace harness {

using inextensible::Positions;
using inextensible::State;

namespace {

constexpr double same_time = 1e-9;  // s; states add up their steps

// Area covered by triangles seen from above: pixel centres of a raster, over size^2.
double shadow_area(const Scene& scene, const Positions& x) {
  constexpr int pixels = 512;
  const double reach = 0.75 * scene.size;  // a square cloth of side 1 reaches 0.71 from its middle
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
  return static_cast<double>(count) * pixel * pixel / (scene.size * scene.size);
}

// Two passes: a spread that is small beside the mean keeps its digits.
std::pair<double, double> mean_and_deviation(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double value : values) mean += value / n;
  for (const double value : values) squares += std::pow(value - mean, 2) / (n - 1);
  return {mean, std::sqrt(squares)};
}

// The vertices along the hem, in order: sides of one triangle only. Empty where there is not one
// loop.
std::vector<int> hem_of(const Scene& scene) {
  std::set<std::pair<int, int>> open;  // sides of one triangle so far
  for (const auto& corners : scene.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      const std::pair side{std::min(a, b), std::max(a, b)};
      if (open.erase(side) == 0) open.insert(side);
    }
  }
  std::map<int, std::vector<int>> beside;
  for (const auto& [a, b] : open) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::vector<int> hem;
  if (beside.empty()) return hem;
  int before = -1, at = beside.begin()->first;
  do {
    const std::vector<int>& both = beside[at];
    if (both.size() != 2) return {};
    hem.push_back(at);
    const int after = both[0] == before ? both[1] : both[0];
    before = at;
    at = after;
  } while (at != hem.front() && hem.size() < beside.size());
  return hem.size() == beside.size() ? hem : std::vector<int>();
}

}  // namespace

int count_folds(const Scene& scene, const Positions& x) {
  constexpr double least = 0.02;
  std::vector<int> hem = hem_of(scene);
  if (hem.empty()) return 0;
  const auto lower = [&](int a, int b) { return x(1, a) < x(1, b); };
  std::rotate(hem.begin(), std::min_element(hem.begin(), hem.end(), lower), hem.end());
  hem.push_back(hem.front());
  // From the lowest vertex, a fold is a rise above the last valley and a fall below the last crest.
  int folds = 0;
  bool rising = true;
  double valley = x(1, hem.front()), crest = valley;
  for (const int vertex : hem) {
    const double y = x(1, vertex);
    crest = std::max(crest, y);
    valley = std::min(valley, y);
    if (rising ? crest - y < least * scene.size : y - valley < least * scene.size) continue;
    folds += rising ? 1 : 0;
    rising = !rising;
    (rising ? crest : valley) = y;
  }
  return folds;
}

std::map<std::string, double> rest_difference(const Scene& scene, const Positions& x,
                                              const Positions& y) {
  const ShapeStatistics a = shape_statistics(scene, x), b = shape_statistics(scene, y);
  std::map<std::string, double> difference{
      {"folds", count_folds(scene, x) - count_folds(scene, y)}};
  for (const auto& [name, member] : shape_statistic_infos) {
    if (member != &ShapeStatistics::kinetic_energy) difference[name] = a.*member - b.*member;
  }
  return difference;
}

void to_json(nlohmann::json& row, const ShapeStatistics& shape) {
  row = nlohmann::json::array();
  for (const auto& info : shape_statistic_infos) row.push_back(shape.*info.member);
}

void from_json(const nlohmann::json& row, ShapeStatistics& shape) {
  for (std::size_t k = 0; k < shape_statistic_infos.size(); ++k)
    row.at(k).get_to(shape.*shape_statistic_infos[k].member);
}

bool is_cloth(const Scene& scene) { return !scene.triangles.empty(); }

ShapeStatistics shape_statistics(const Scene& scene, const Positions& x) {
  ShapeStatistics shape;
  shape.potential_energy = inextensible::potential_energy(*scene.problem, x) / energy_scale(scene);
  for (const int corner : scene.corners)
    shape.corner_height += x(1, corner) / scene.size / static_cast<double>(scene.corners.size());
  if (is_cloth(scene)) shape.shadow = shadow_area(scene, x);
  return shape;
}

ShapeRecord::ShapeRecord(const Scene& scene, std::vector<double> times,
                         inextensible::Velocities velocities)
    : scene_(scene), times_(std::move(times)), velocities_(velocities) {}

void ShapeRecord::sample(const Positions& x) { series_.push_back(shape_statistics(scene_, x)); }

// Linear through the last two instants, and no less than nothing beyond them.
double ShapeRecord::kinetic_at(double time) const {
  const double slope = (last_.kinetic - before_.kinetic) / (last_.time - before_.time);
  return std::max(0.0, last_.kinetic + slope * (time - last_.time));
}

void ShapeRecord::step(const State& state, double h) {
  const bool whole = velocities_ == inextensible::Velocities::whole_step;
  before_ = last_;
  last_ = {whole ? state.time : state.time - h / 2,
           inextensible::kinetic_energy(*scene_.problem, state.v) / energy_scale(scene_)};
  ++steps_;
  for (; settled_ < series_.size() && times_[settled_] <= last_.time + same_time; ++settled_)
    series_[settled_].kinetic_energy = steps_ == 1 ? last_.kinetic : kinetic_at(times_[settled_]);
}

// No velocity follows the last step: its own, or what the last two foretell if that is less.
const ShapeSeries& ShapeRecord::finish() {
  for (; settled_ < series_.size(); ++settled_) {
    double kinetic = last_.kinetic;
    if (steps_ > 1) kinetic = std::min(kinetic, kinetic_at(times_[settled_]));
    series_[settled_].kinetic_energy = kinetic;
  }
  return series_;
}

Ensemble ensemble_of(const std::vector<ShapeSeries>& runs) {
  Ensemble e;
  e.runs = static_cast<int>(runs.size());
  const std::size_t times = runs.front().size();
  std::vector<double> values(runs.size()), kinetic_sums(runs.size(), 0);
  for (std::size_t i = 0; i < times; ++i) {
    ShapeStatistics mean, deviation;
    for (const auto& [name, member] : shape_statistic_infos) {
      for (std::size_t k = 0; k < runs.size(); ++k) values[k] = runs[k][i].*member;
      std::tie(mean.*member, deviation.*member) = mean_and_deviation(values);
    }
    e.mean.push_back(mean);
    e.deviation.push_back(deviation);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      kinetic_sums[k] += runs[k][i].kinetic_energy;
      values[k] = kinetic_sums[k] / static_cast<double>(i + 1);
    }
    e.kinetic_deviation.push_back(mean_and_deviation(values).second);
  }
  return e;
}

void measure_shape(const Ensemble& ensemble, const std::vector<double>& times,
                   const ShapeSeries& run, Measures& measures) {
  Measures found = measures;
  const std::size_t count = std::min(run.size(), ensemble.mean.size());
  if (count > 0) found.shape = 0;
  double own = 0, mean = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (const auto& [name, member] : shape_statistic_infos) {
      const double off = std::abs(run[i].*member - ensemble.mean[i].*member);
      if (std::isnan(off)) return;
      const double error = off - sure_deviations * ensemble.deviation[i].*member;
      if (error <= found.shape) continue;
      found.shape = error;
      found.shape_statistic = name;
      found.shape_time = times[i];
    }
    own += run[i].kinetic_energy;
    mean += ensemble.mean[i].kinetic_energy;
  }
  if (mean > 0) {
    found.kinetic_ratio = own / mean;
    found.kinetic_spread =
        sure_deviations * ensemble.kinetic_deviation[count - 1] * static_cast<double>(count) / mean;
  }
  measures = std::move(found);
}

bool kinetic_energy_lost(double ratio, double spread) {
  const bool far = ratio < least_kinetic_ratio || ratio > largest_kinetic_ratio;
  return far && std::abs(ratio - 1) > spread;
}

}  // namespace harness
