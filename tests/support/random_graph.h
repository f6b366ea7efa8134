// Random graphs in space, for what must hold beyond grids.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>

#include "support/random_mesh.h"

namespace inextensible::testing {

// A random tree of n vertices with `extra` further edges, none twice; positions random in a cube,
// at rest; masses log-uniform in [lightest, 1]; the first `pinned` vertices pinned. Zero gravity.
// With extra well below 2 n the gradients are independent (a generic framework in space).
inline RandomMesh random_graph(Random& random, int n, int extra, int pinned, double lightest) {
  const Positions x = Positions::NullaryExpr(3, n, [&] { return uniform(random, -1, 1); });
  std::vector<double> mass;
  for (int v = 0; v < n; ++v) mass.push_back(std::pow(lightest, uniform(random, 0, 1)));
  std::vector<int> pins(pinned);
  std::iota(pins.begin(), pins.end(), 0);
  std::vector<Edge> edges;
  std::set<std::pair<int, int>> taken;
  const auto join = [&](int a, int b) {
    if (a == b || (a < pinned && b < pinned) || !taken.insert(std::minmax(a, b)).second)
      return false;
    edges.push_back({a, b});
    return true;
  };
  const auto vertex = [&](int below) {
    return static_cast<int>(random() % static_cast<std::uint64_t>(below));
  };
  for (int v = std::max(pinned, 1); v < n; ++v) join(v, vertex(v));
  for (int added = 0; added < extra;) added += join(vertex(n), vertex(n));
  return {std::make_shared<const Problem>(parts_at_rest(x, edges, mass, pins)), x};
}

// Some hairs in one problem, their edges in random directions: pinned at one end, somewhere
// between, or nowhere. At rest in random shape, masses log-uniform in [lightest, 1]. `twice`: some
// edges are there a second time.
inline RandomMesh random_chains(Random& random, int chains, double lightest = 1e-3,
                                bool twice = false) {
  std::vector<double> mass;
  std::vector<int> pins;
  std::vector<Edge> edges;
  for (int chain = 0; chain < chains; ++chain) {
    const int first = static_cast<int>(mass.size());
    const int length = 1 + static_cast<int>(random() % 12);
    const int pin = first + static_cast<int>(random() % 13);
    for (int v = first; v < first + length; ++v) {
      mass.push_back(std::pow(lightest, uniform(random, 0, 1)));
      if (v == pin) pins.push_back(v);
      if (v > first) edges.push_back(random() % 2 ? Edge{v - 1, v} : Edge{v, v - 1});
      if (twice && v > first && random() % 4 == 0) edges.push_back({v - 1, v});
    }
  }
  std::shuffle(edges.begin(), edges.end(), random);
  const Positions x =
      Positions::NullaryExpr(3, std::ssize(mass), [&] { return uniform(random, -1, 1); });
  return {std::make_shared<const Problem>(parts_at_rest(x, edges, mass, pins)), x};
}

}  // namespace inextensible::testing
