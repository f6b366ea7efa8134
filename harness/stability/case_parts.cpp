#include "harness/stability/case_parts.h"

#include <cmath>
#include <memory>

namespace harness::case_parts {

using inextensible::Positions;
using inextensible::Problem;

Mesh points(int n, double mass) {
  Mesh mesh;
  mesh.parts.mass.assign(n, mass);
  mesh.start.x.setZero(3, n);
  mesh.start.v.setZero(3, n);
  return mesh;
}

void join(Mesh& mesh, int a, int b, double rest_length) {
  mesh.parts.edges.push_back({a, b});
  mesh.parts.rest_length.push_back(rest_length);
}

Mesh chain(int links, const Eigen::Vector3d& direction, bool pinned) {
  const double l = 1.0 / links;
  Mesh mesh = points(links + 1, 1.0 / (links + 1));
  for (int i = 0; i <= links; ++i) {
    mesh.start.x.col(i) = i * l * direction;
    if (i > 0) join(mesh, i - 1, i, l);
  }
  if (pinned) mesh.parts.pinned = {0};
  return mesh;
}

Mesh cloth(int n, bool diagonals) {
  const double l = 1.0 / (n - 1);
  Mesh mesh = points(n * n, 0.2 / (n * n));
  const auto vertex = [n](int i, int j) { return i * n + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.start.x.col(vertex(i, j)) << j * l, 0, i * l;
      if (j + 1 < n) join(mesh, vertex(i, j), vertex(i, j + 1), l);
      if (i + 1 < n) join(mesh, vertex(i, j), vertex(i + 1, j), l);
      if (diagonals && i + 1 < n && j + 1 < n)
        join(mesh, vertex(i, j), vertex(i + 1, j + 1), std::sqrt(2.0) * l);
    }
  }
  mesh.parts.pinned = {vertex(0, 0), vertex(0, n - 1)};
  return mesh;
}

// Springs promise no limit: a stiffness that would keep it in a fall of a few weights.
Trial trial_of(Scene scene, double step, int steps, double strain_limit) {
  const Problem& problem = *scene.problem;
  Trial trial;
  trial.slack = strain_limit * problem.longest_rest_length();
  trial.step = step;
  trial.steps = steps;
  trial.strain_limit = strain_limit;
  trial.stiffness = 20 * g * problem.total_mass() / strain_limit;
  trial.scene = std::move(scene);
  return trial;
}

Trial trial_of(Scene scene, double step, double strain_limit) {
  const int steps = static_cast<int>(std::lround(scene.duration / step));
  return trial_of(std::move(scene), step, steps, strain_limit);
}

Trial trial_of(Mesh mesh, double step, int steps, double strain_limit) {
  Scene scene;
  scene.size = mesh.size;
  scene.start = std::move(mesh.start);
  scene.problem = std::make_shared<const Problem>(std::move(mesh.parts));
  return trial_of(std::move(scene), step, steps, strain_limit);
}

Scene scene_of(const char* name, const SceneParameters& given) {
  const auto found_type = find_scene(name);
  const SceneType& type = *found_type;
  return type.build(complete_parameters(type, given));
}

void add_noise(Positions& x, const std::vector<int>& pinned, double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> noise(-size, size);
  const Positions before = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise(random);
  for (const int pin : pinned) x.col(pin) = before.col(pin);
}

}  // namespace harness::case_parts
