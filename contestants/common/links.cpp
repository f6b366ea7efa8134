#include "contestants/common/links.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "solvers/problem/problem.h"

namespace engines {
namespace {

using inextensible::Problem;
using inextensible::State;

[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument("joint coordinates want a chain hung from one end: " + why);
}

int only_pin(const Problem& problem) {
  const std::size_t pins = problem.pinned().size();
  if (pins != 1) refuse(std::to_string(pins) + " vertices are pinned");
  return problem.pinned().front();
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

Links::Links(const Problem& problem) : pin(only_pin(problem)) {
  const auto at = neighbours_of(problem);
  if (at[pin].size() != 1) refuse("the pin has " + std::to_string(at[pin].size()) + " edges");
  int before = -1, now = pin;
  while (true) {
    const auto next = std::find_if(at[now].begin(), at[now].end(),
                                   [before](const auto& n) { return n.vertex != before; });
    if (next == at[now].end()) break;
    before = now;
    now = next->vertex;
    if (at[now].size() > 2) refuse("vertex " + std::to_string(now) + " has more than two edges");
    vertex.push_back(now);
    length.push_back(problem.rest_length()[next->edge]);
    mass.push_back(problem.mass()[now]);
  }
  if (count() + 1 != problem.vertices()) refuse("some vertices do not hang on the pin");
}

bool planar(const Links& links, const Problem& problem, const State& state) {
  const double depth = state.x(2, links.pin);
  return problem.gravity().z() == 0 && (state.x.row(2).array() == depth).all() &&
         (state.v.row(2).array() == 0).all();
}

bool find_poses(const Links& links, const State& state, bool planar, LinkPoses& poses) {
  Eigen::Vector3d from = state.x.col(links.pin), rate_before = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_before = Eigen::Vector3d::Zero();
  for (int i = 0; i < links.count(); ++i) {
    const int vertex = links.vertex[i];
    Eigen::Vector3d e = state.x.col(vertex) - from;
    const double distance = e.norm();
    if (!(distance > 0) || !std::isfinite(distance)) return false;
    e /= distance;
    poses[i].axes = planar ? axes_in_plane(e) : axes_along(e);
    const Eigen::Vector3d across = e.cross(state.v.col(vertex) - velocity_before) / links.length[i];
    const Eigen::Vector3d rate = planar ? across : across + e.dot(rate_before) * e;
    poses[i].rate = rate - rate_before;
    from = state.x.col(vertex);
    velocity_before = state.v.col(vertex);
    rate_before = rate;
  }
  return true;
}

}  // namespace engines
