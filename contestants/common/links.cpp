#include "contestants/common/links.h"

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

// Whether a state is in a plane of x and y.
bool planar(const double* x, const double* v, int count) {
  const auto heights = columns(x, count).row(2), speeds = columns(v, count).row(2);
  return (heights.array() == heights(0)).all() && (speeds.array() == 0).all();
}

// The smallest rotation that takes the x axis to e, one about z as long as e.z = 0.
Eigen::Quaterniond turn_to(const Eigen::Vector3d& e) {
  const double across = std::hypot(e.y(), e.z());
  const Eigen::Vector3d axis(0, -e.z() / across, e.y() / across);
  const double angle = std::atan2(across, e.x());
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, across > 0 ? axis : Eigen::Vector3d::UnitZ()));
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
  flat = scene.x && gravity.z() == 0 && planar(scene.x, scene.v, scene.vertices);
}

void Links::find_poses(const InextensibleStep& step) {
  flat = flat && planar(step.x, step.v, count() + 1);
  const auto places = columns(step.x, count() + 1), velocities = columns(step.v, count() + 1);
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  // of the link before, and its rate
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (int i = 0, from = pin; i < count(); from = vertex[i++]) {
    const Eigen::Vector3d d = places.col(vertex[i]) - places.col(from), e = d.normalized();
    if (!(d.norm() > 0 && e.allFinite()))
      throw Refusal{INEXTENSIBLE_NOT_FINITE, "a link has no direction"};
    poses[i].turn = turn_to(axes.conjugate() * e);
    axes = (axes * poses[i].turn).normalized();
    const Eigen::Vector3d across = velocities.col(vertex[i]) - velocities.col(from);
    const Eigen::Vector3d added = e.cross(across / length[i] - rate.cross(e));
    poses[i].rate = axes.conjugate() * added;
    rate += added;
  }
}

}  // namespace engines
