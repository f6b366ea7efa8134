// Chains that begin straight or folded: released, taut between pins, and folded into a U, one arm
// of which moves along the other: faster and faster, because what moves becomes less and its energy
// stays.
#include <gsl/gsl_integration.h>

#include <cmath>
#include <memory>

#include "harness/scenes/meshes.h"

namespace harness {
namespace {

// n vertices on a straight horizontal line, vertex 0 pinned, at rest, released.
Scene build_chain(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  const int n = whole(p);
  for (int i = 0; i < n; ++i) chain.scene.start.x(0, i) = p.at("length") * i / (n - 1);
  return released(std::move(chain), {0});
}

// n vertices on a straight horizontal line, both ends pinned `stretch` times its length apart.
Scene build_taut_row(const SceneParameters& p) {
  Draft row = vertex_row(p);
  const int n = whole(p);
  const double span = p.at("length") * p.at("stretch");
  Scene::Mirror left_right{{1, 0, 0}, {}};
  for (int i = 0; i < n; ++i) {
    row.scene.start.x(0, i) = 0.5 * span * (2 * i - (n - 1)) / (n - 1);
    left_right.image.push_back(n - 1 - i);
  }
  row.scene.mirrors.push_back(std::move(left_right));
  return released(std::move(row), {0, n - 1});
}

// Vertex 0, the pin, is at the top; the still arm hangs from it, and one link across (two, if the
// number of links is even) leads to the other arm, which ends at the top.
Scene build_folded(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  const int n = whole(p), links = n - 1;
  const double link = row_link(p), speed = value_or_zero(p, "speed");
  const int arm = (links - 1) / 2, across = links - 2 * arm;
  inextensible::State& start = chain.scene.start;
  for (int i = 1; i < n; ++i) {
    const Eigen::Vector3d along = i <= arm            ? Eigen::Vector3d(0, -link, 0)
                                  : i <= arm + across ? Eigen::Vector3d(link, 0, 0)
                                                      : Eigen::Vector3d(0, link, 0);
    start.x.col(i) = start.x.col(i - 1) + along;
    if (i >= arm + across) start.v(1, i) = -speed;
  }
  return released(std::move(chain), {0});
}

SceneParameterInfo vertices(int n, double least) {
  return {"n", static_cast<double>(n), "vertices", least, 10'000'000, true};
}

}  // namespace

// t = integral of L ds / v; with s = u^2 the integrand is smooth.
double folded_fall_time(double part, double length, double gravity) {
  const std::unique_ptr<gsl_integration_glfixed_table,
                        decltype(&gsl_integration_glfixed_table_free)>
      nodes(gsl_integration_glfixed_table_alloc(32), gsl_integration_glfixed_table_free);
  gsl_function rate{[](double u, void*) { return 2 * std::sqrt((1 - u * u) / (2 - u * u)); },
                    nullptr};
  return std::sqrt(length / gravity) *
         gsl_integration_glfixed(&rate, 0, std::sqrt(part), nodes.get());
}

std::vector<SceneType> line_scenes() {
  return {
      {.name = "chain",
       .summary = "a straight horizontal chain, pinned at one end, released",
       .parameters = row_parameters(vertices(80, 2), {gravity_info()}),
       .build = build_chain,
       .counts = count_row,
       .pendulum = true},
      {.name = "taut_row",
       .summary = "a straight chain between two pins at its full length: J W J^T is singular",
       .parameters = row_parameters(
           vertices(31, 3),
           {gravity_info(),
            {"stretch", 1, "distance of the pins over the length; above 1: infeasible", 0, 100}}),
       .build = build_taut_row,
       .counts = count_row},
      {.name = "folded_chain",
       .summary = "a chain folded into a U, pinned at one end: the other falls faster than free",
       .parameters = row_parameters(vertices(80, 4), {gravity_info(0)}, 0.4),
       .build = build_folded,
       .counts = count_row,
       .like = "chain"},
      {.name = "whip",
       .summary =
           "a chain folded into a U without weight, one arm pinned, the other moving: its end "
           "cracks",
       .parameters = row_parameters(
           vertices(80, 4), {{"speed", 1, "of the moving arm at the start, m/s", 0, 1e4}}, 0.7),
       .build = build_folded,
       .counts = count_row,
       .like = "chain"}};
}

}  // namespace harness
