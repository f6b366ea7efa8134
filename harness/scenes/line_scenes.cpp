// Scenes of vertices on a line.
#include "harness/scenes/meshes.h"
#include "harness/scenes/rows.h"

namespace harness {
namespace {

// n vertices on a straight horizontal line, vertex 0 pinned, at rest, released.
Scene build_chain(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  const int n = static_cast<int>(p.at("n"));
  const double length = p.at("length");
  chain.parts.pinned = {0};
  for (int i = 0; i < n; ++i) chain.scene.start.x(0, i) = length * i / (n - 1);
  chain.scene.conserves_energy = true;
  return finished(std::move(chain));
}

// n vertices on a straight horizontal line, both ends pinned `stretch` times its length apart.
Scene build_taut_row(const SceneParameters& p) {
  Draft row = vertex_row(p);
  const int n = static_cast<int>(p.at("n"));
  const double span = p.at("length") * p.at("stretch");
  row.parts.pinned = {0, n - 1};
  Scene::Mirror left_right{{1, 0, 0}, {}};
  for (int i = 0; i < n; ++i) {
    row.scene.start.x(0, i) = 0.5 * span * (2 * i - (n - 1)) / (n - 1);
    left_right.image.push_back(n - 1 - i);
  }
  row.scene.mirrors.push_back(std::move(left_right));
  row.scene.conserves_energy = true;
  return finished(std::move(row));
}

}  // namespace

SceneType chain_scene() {
  SceneType row{"chain",
                "a straight horizontal chain, pinned at one end, released",
                "n",
                {{"n", 80, "vertices", 2, 10'000'000, true},
                 {"length", 1, "m", 0, 1e6},
                 {"mass", 1, "total, kg", 0, 1e6},
                 {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
                 {"duration", 1, "s", 0, 1e4}},
                build_chain,
                count_row};
  row.pendulum = true;
  return row;
}

SceneType taut_row_scene() {
  return {"taut_row",
          "a straight chain between two pins at its full length: J W J^T is singular",
          "n",
          {{"n", 31, "vertices", 3, 10'000'000, true},
           {"length", 1, "m", 0, 1e6},
           {"stretch", 1, "distance of the pins over the length; above 1: infeasible", 0, 100},
           {"mass", 1, "total, kg", 0, 1e6},
           {"gravity", 9.81, "m/s^2, along -y", -1e4, 1e4},
           {"duration", 1, "s", 0, 1e4}},
          build_taut_row,
          count_row};
}

}  // namespace harness
