#include "contestants/common/links.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace engines {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument("joint coordinates want a chain hung from one end: " + why);
}

int only_pin(const InextensibleScene& scene) {
  const double* end = scene.mass + scene.vertices;
  const auto pins = std::count(scene.mass, end, 0.0);
  if (pins != 1) refuse(std::to_string(pins) + " vertices are pinned");
  return static_cast<int>(std::find(scene.mass, end, 0.0) - scene.mass);
}

// Duff et al. 2017, Building an orthonormal basis, revisited: continuous but at e.z = 0.
Eigen::Matrix3d axes_along(const Eigen::Vector3d& e) {
  const double sign = std::copysign(1.0, e.z()), a = -1 / (sign + e.z()), b = e.x() * e.y() * a;
  Eigen::Matrix3d axes;
  axes.col(0) = e;
  axes.col(1) << 1 + sign * e.x() * e.x() * a, sign * b, -sign * e.x();
  axes.col(2) << b, sign + e.y() * e.y() * a, -e.y();
  return axes;
}

Eigen::Matrix3d axes_in_plane(const Eigen::Vector3d& e) {
  Eigen::Matrix3d axes;
  axes << e.x(), -e.y(), 0, e.y(), e.x(), 0, 0, 0, 1;
  return axes;
}

}  // namespace

Links::Links(const InextensibleScene& scene)
    : pin(only_pin(scene)), gravity(Eigen::Map<const Eigen::Vector3d>(scene.gravity)) {
  std::vector<std::vector<int>> at(static_cast<std::size_t>(scene.vertices));  // edges
  for (int k = 0; k < scene.edges; ++k) {
    at[scene.edge[2 * k]].push_back(k);
    at[scene.edge[2 * k + 1]].push_back(k);
  }
  if (at[pin].size() != 1) refuse("the pin has " + std::to_string(at[pin].size()) + " edges");
  int before = -1, now = pin;  // edge and vertex
  while (true) {
    const auto next =
        std::find_if(at[now].begin(), at[now].end(), [before](int edge) { return edge != before; });
    if (next == at[now].end()) break;
    before = *next;
    now = scene.edge[2 * before] + scene.edge[2 * before + 1] - now;
    if (at[now].size() > 2) refuse("vertex " + std::to_string(now) + " has more than two edges");
    vertex.push_back(now);
    length.push_back(scene.rest_length[before]);
    mass.push_back(scene.mass[now]);
  }
  if (count() + 1 != scene.vertices) refuse("some vertices do not hang on the pin");
  poses.resize(vertex.size());
  flat = scene.x && planar(scene.x, scene.v);
}

bool Links::planar(const double* x, const double* v) const {
  const auto places = columns(x, count() + 1), velocities = columns(v, count() + 1);
  return gravity.z() == 0 && (places.row(2).array() == places(2, pin)).all() &&
         (velocities.row(2).array() == 0).all();
}

bool Links::find_poses(const double* x, const double* v) {
  flat = flat && planar(x, v);
  const auto places = columns(x, count() + 1), velocities = columns(v, count() + 1);
  Eigen::Vector3d from = places.col(pin), rate_before = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_before = Eigen::Vector3d::Zero();
  for (int i = 0; i < count(); ++i) {
    Eigen::Vector3d e = places.col(vertex[i]) - from;
    const double distance = e.norm();
    if (!(distance > 0) || !std::isfinite(distance)) return false;
    e /= distance;
    poses[i].axes = flat ? axes_in_plane(e) : axes_along(e);
    const Eigen::Vector3d across = e.cross(velocities.col(vertex[i]) - velocity_before) / length[i];
    const Eigen::Vector3d rate = flat ? across : across + e.dot(rate_before) * e;
    poses[i].rate = rate - rate_before;
    from = places.col(vertex[i]);
    velocity_before = velocities.col(vertex[i]);
    rate_before = rate;
  }
  return true;
}

}  // namespace engines
