#include "harness/scenes/folded_scenes.h"

#include <gsl/gsl_integration.h>

#include <cmath>
#include <memory>

#include "harness/scenes/meshes.h"
#include "harness/scenes/rows.h"

namespace harness {
namespace {

// Vertex 0, the pin, is at the top; the still arm hangs from it, and one link across (two, if the
// number of links is even) leads to the other arm, which ends at the top.
Draft folded_row(const SceneParameters& p, double speed) {
  Draft chain = vertex_row(p);
  const int n = static_cast<int>(p.at("n")), links = n - 1;
  const double link = row_link(p);
  const int arm = (links - 1) / 2, across = links - 2 * arm;
  inextensible::State& start = chain.scene.start;
  for (int i = 1; i < n; ++i) {
    const Eigen::Vector3d along = i <= arm            ? Eigen::Vector3d(0, -link, 0)
                                  : i <= arm + across ? Eigen::Vector3d(link, 0, 0)
                                                      : Eigen::Vector3d(0, link, 0);
    start.x.col(i) = start.x.col(i - 1) + along;
    if (i >= arm + across) start.v(1, i) = -speed;
  }
  chain.parts.pinned = {0};
  chain.scene.conserves_energy = true;
  return chain;
}

Scene build_folded_chain(const SceneParameters& p) { return finished(folded_row(p, 0)); }

Scene build_whip(const SceneParameters& given) {
  SceneParameters p = given;
  p["gravity"] = 0;
  return finished(folded_row(p, p.at("speed")));
}

const SceneParameterInfo vertices_info{"n", 80, "vertices", 4, 10'000'000, true};
const SceneParameterInfo length_info{"length", 1, "m", 0, 1e6};
const SceneParameterInfo mass_info{"mass", 1, "total, kg", 0, 1e6};

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

SceneType folded_chain_scene() {
  return {"folded_chain",
          "a chain folded into a U, pinned at one end: the other falls faster than free",
          "n",
          {vertices_info,
           length_info,
           mass_info,
           {"gravity", 9.81, "m/s^2, along -y", 0, 1e4},
           {"duration", 0.4, "s", 0, 1e4}},
          build_folded_chain,
          count_row,
          nullptr,
          "chain"};
}

SceneType whip_scene() {
  return {
      "whip",
      "a chain folded into a U without weight, one arm pinned, the other moving: its end cracks",
      "n",
      {vertices_info,
       length_info,
       mass_info,
       {"speed", 1, "of the moving arm at the start, m/s", 0, 1e4},
       {"duration", 0.7, "s", 0, 1e4}},
      build_whip,
      count_row,
      nullptr,
      "chain"};
}

}  // namespace harness
