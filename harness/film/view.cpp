#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/film/pictures.h"

namespace harness {
namespace {

using Eigen::Vector3d;
using inextensible::Positions;

constexpr double half_angle = 12 * std::numbers::pi / 180;
constexpr double margin = 1.06;
// How far cloth is followed, over the radius of all at the start: about a body, and without one.
constexpr double near_body = 1.1, near_start = 3;

using Box = Eigen::AlignedBox3d;

void extend(Box& box, const Positions& x) {
  for (const auto& point : x.colwise())
    if (point.allFinite()) box.extend(Vector3d(point));
}

double reach(const Positions& x, const Vector3d& from) {
  return x.cols() == 0 ? 0 : (x.colwise() - from).colwise().norm().maxCoeff();
}

// The points that are no farther from `middle` than `followed`.
Positions near(const Positions& x, const Vector3d& middle, double followed) {
  Positions kept(3, x.cols());
  Eigen::Index count = 0;
  for (const auto& point : x.colwise())
    if ((point - middle).norm() <= followed) kept.col(count++) = point;
  return kept.leftCols(count);
}

// All that the camera must see.
std::vector<Positions> in_sight(const Recording& recording,
                                const std::vector<std::size_t>& frames) {
  const FilmScene& stage = recording.stage;
  const Positions& start = recording.takes.at(0).frames.at(0);
  const bool body = !stage.body.empty();
  const Positions body_start = body ? body_at(stage, 0) : start;
  Box about;
  extend(about, body_start);
  const Vector3d at_first = about.center();
  const double followed = (body ? near_body : near_start) *
                          std::max(reach(start, at_first), reach(body_start, at_first));
  std::vector<Positions> all;
  for (const FilmRun& take : recording.takes) {
    for (const std::size_t shown : frames) {
      const std::size_t frame = std::min(shown, take.frames.size() - 1);
      Vector3d middle = at_first;
      if (!stage.body_poses.empty())
        middle = stage.body_poses.at(frame)(stage.body_poses[0].inverse()(middle));
      all.push_back(near(take.frames[frame], middle, followed));
      if (body) all.push_back(body_at(stage, frame));
    }
  }
  return all;
}

bool in_a_plane(const std::vector<Positions>& all) {
  Box box;
  for (const Positions& x : all) extend(box, x);
  return box.sizes().z() < 1e-3 * box.sizes().maxCoeff();
}

}  // namespace

int View::height(int width) const {
  return std::max(1, static_cast<int>(std::lround(width * aspect)));
}

Vector3d View::ray(double x, double y) const {
  return (tangent * (x * right + y * aspect * up) - towards).normalized();
}

Eigen::Vector2d View::seen(const Vector3d& point) const {
  const Vector3d from = point - eye;
  const double depth = -from.dot(towards) * tangent;
  return {from.dot(right) / depth, from.dot(up) / (depth * aspect)};
}

View view_of(const Recording& recording, const std::vector<std::size_t>& frames) {
  const std::vector<Positions> all = in_sight(recording, frames);
  View view;
  view.tangent = std::tan(half_angle);
  view.towards = (in_a_plane(all) ? Vector3d(0, 0.12, 1) : Vector3d(0.55, 0.45, 1)).normalized();
  view.right = Vector3d::UnitY().cross(view.towards).normalized();
  view.up = view.towards.cross(view.right);
  Eigen::Matrix3d axes;
  axes << view.right.transpose(), view.up.transpose(), view.towards.transpose();
  Box box;
  for (const Positions& x : all) extend(box, axes * x);
  const Vector3d middle = box.center(), half = (0.5 * box.sizes()).cwiseMax(1e-6);
  view.aspect = std::clamp(half.y() / half.x(), 0.5, 1.3);
  double distance = 0;
  for (const Positions& x : all) {
    for (const auto& point : x.colwise()) {
      const Vector3d p = axes * point - middle;
      const double wide = std::max(std::abs(p.x()), std::abs(p.y()) / view.aspect);
      if (p.allFinite()) distance = std::max(distance, margin * wide / view.tangent + p.z());
    }
  }
  view.size = std::max(half.x(), half.y());
  view.centre = axes.transpose() * middle;
  view.eye = view.centre + std::max(distance, 1e-6) * view.towards;
  return view;
}

}  // namespace harness
