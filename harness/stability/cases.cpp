#include "harness/stability/hard_case.h"

namespace harness::cases {

Draft points(int n, double mass) {
  Draft mesh(n, {{"gravity", g}, {"duration", 0}});
  mesh.parts.mass.assign(n, mass);
  return mesh;
}

Draft chain(int links, const Eigen::Vector3d& direction, bool pinned) {
  Draft mesh =
      vertex_row({{"n", links + 1}, {"length", 1}, {"mass", 1}, {"gravity", g}, {"duration", 0}});
  for (int i = 0; i <= links; ++i) mesh.scene.start.x.col(i) = i * (1.0 / links) * direction;
  if (pinned) mesh.parts.pinned = {0};
  return mesh;
}

Draft cloth(int n, bool diagonals) {
  const double l = 1.0 / (n - 1);
  Draft mesh = points(n * n, 0.2 / (n * n));
  const auto vertex = [n](int i, int j) { return i * n + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.scene.start.x.col(vertex(i, j)) << j * l, 0, i * l;
      if (j + 1 < n) mesh.constrain(vertex(i, j), vertex(i, j + 1), l);
      if (i + 1 < n) mesh.constrain(vertex(i, j), vertex(i + 1, j), l);
      if (diagonals && i + 1 < n && j + 1 < n)
        mesh.constrain(vertex(i, j), vertex(i + 1, j + 1), std::sqrt(2.0) * l);
    }
  mesh.parts.pinned = {vertex(0, 0), vertex(0, n - 1)};
  return mesh;
}

Draft hung_cloth(int n) {
  Draft mesh = cloth(n);
  mesh.parts.pinned = {0};
  return mesh;
}

Draft midpoint_cloth(int n) {
  const Draft corners = cloth(n, true);
  std::map<std::pair<int, int>, int> midpoint_of;
  for (const auto [a, b] : corners.parts.edges)
    midpoint_of.emplace(std::minmax(a, b), static_cast<int>(midpoint_of.size()));
  Draft mesh = points(static_cast<int>(midpoint_of.size()), 0);
  const Positions& x = corners.scene.start.x;
  for (const auto& [ends, v] : midpoint_of)
    mesh.scene.start.x.col(v) = 0.5 * (x.col(ends.first) + x.col(ends.second));
  const double mass = 0.2 / (2 * (n - 1) * (n - 1));  // of a triangle
  const auto add = [&](std::array<int, 3> corner) {
    for (int i = 0; i < 3; ++i) {
      const int a = corner[i], b = corner[(i + 1) % 3], c = corner[(i + 2) % 3];
      const int first = midpoint_of.at(std::minmax(a, b)),
                second = midpoint_of.at(std::minmax(a, c));
      mesh.constrain(first, second, 0.5 * (x.col(b) - x.col(c)).norm());
      mesh.parts.mass[first] += mass / 3;
    }
  };
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int v = i * n + j;  // and the diagonal from it
      add({v, v + 1, v + n + 1});
      add({v, v + n + 1, v + n});
    }
  mesh.parts.pinned = {midpoint_of.at({0, 1}), midpoint_of.at({n - 2, n - 1})};
  return mesh;
}

// Springs promise no limit: a stiffness that would keep it in a fall of a few weights.
Trial trial_of(Scene scene, double step, int steps, double strain_limit) {
  const Problem& problem = *scene.problem;
  return {.scene = scene,
          .step = step,
          .steps = steps > 0 ? steps : static_cast<int>(std::lround(scene.duration / step)),
          .strain_limit = strain_limit,
          .stiffness = 20 * g * problem.total_mass() / strain_limit,
          .slack = strain_limit * problem.longest_rest_length()};
}

Trial trial_of(Draft mesh, double step, int steps, double strain_limit) {
  return trial_of(finished(std::move(mesh)), step, steps, strain_limit);
}

void add_noise(Positions& x, const std::vector<int>& pinned, double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> noise(-size, size);
  const Positions before = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise(random);
  for (const int pin : pinned) x.col(pin) = before.col(pin);
}

}  // namespace harness::cases
