#include "solvers/systems/spring_hessian.h"

#include <algorithm>

#include "solvers/linear/spd_solvers.h"
#include "solvers/systems/vertex_blocks.h"

namespace inextensible {
namespace {

// Whether vertices are numbered along chains: every spring joins one to the next.
bool chains(const std::vector<Edge>& pairs) {
  return std::all_of(pairs.begin(), pairs.end(), [](Edge e) { return std::abs(e.a - e.b) == 1; });
}

}  // namespace

SpringHessian::SpringHessian(const Problem& problem, double stiffness, std::string_view wanted) {
  free_place.assign(problem.vertices(), -1);
  for (int v = 0; v < problem.vertices(); ++v) {
    if (problem.inverse_mass()[v] == 0) continue;
    free_place[v] = static_cast<int>(free_vertex.size());
    free_vertex.push_back(v);
  }
  const auto add = [&](Edge e, double rest, double k) {
    springs.push_back({e.a, e.b, -1, -1, rest, k, {}});
  };
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    add(problem.edges()[k], problem.rest_length()[k], stiffness / problem.rest_length()[k]);
  }
  if (const Springs* shear = problem.shear()) {
    for (std::size_t k = 0; k < shear->edges.size(); ++k)
      add(shear->edges[k], shear->rest_length[k], shear->stiffness[k]);
  }
  const int n = static_cast<int>(free_vertex.size());
  std::vector<Edge> pairs = coupled_pairs(problem);
  // Instructions of a second of plain Newton, in 1e6: on the chain of 80, block_tridiagonal 23,
  // multifrontal 54, cholmod_simplicial 79; on the drape of 21 x 21, multifrontal 3400,
  // cholmod_supernodal 5100, cholmod_simplicial 10000.
  linear_solver = wanted != "auto" ? std::string(wanted)
                  : chains(pairs)  ? "block_tridiagonal"
                                   : "multifrontal";
  if (spd_solver(linear_solver).takes == Takes::block_tridiagonal) {
    // Where one chain ends and the next begins the matrix holds zeros.
    for (int f = 1; f < n; ++f) pairs.push_back({f - 1, f});
  } else {
    order_vertices(pairs);
    pairs = coupled_pairs(problem);
  }
  for (const int vertex : free_vertex) free_mass.push_back(problem.mass()[vertex]);
  SymmetricPattern pattern = expand(vertex_graph(n, pairs), triangle_of(linear_solver));
  locate_blocks(problem, pattern);
  entries = pattern.entries();
  solver = make_spd_solver(linear_solver, std::move(pattern));
}

// Coupled pairs of free vertices, by their place among these.
std::vector<Edge> SpringHessian::coupled_pairs(const Problem& problem) const {
  std::vector<Edge> pairs;
  const auto add = [&](int a, int b) {
    const Edge pair{free_place[a], free_place[b]};
    if (pair.a >= 0 && pair.b >= 0 && pair.a != pair.b) pairs.push_back(pair);
  };
  for (const Spring& s : springs) add(s.a, s.b);
  for (const BendingStencil& s : problem.bending()) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) add(s.vertex[i], s.vertex[j]);
    }
  }
  return pairs;
}

void SpringHessian::order_vertices(const std::vector<Edge>& pairs) {
  const std::vector<int> order =
      fill_reducing_order(vertex_graph(static_cast<int>(free_vertex.size()), pairs));
  std::vector<int> ordered(free_vertex.size());
  for (std::size_t f = 0; f < ordered.size(); ++f) {
    ordered[f] = free_vertex[order[f]];
    free_place[ordered[f]] = static_cast<int>(f);
  }
  free_vertex = std::move(ordered);
}

void SpringHessian::locate_blocks(const Problem& problem, const SymmetricPattern& pattern) {
  for (int f = 0; f < static_cast<int>(free_vertex.size()); ++f) {
    const auto [x, y, z] = block_begin(pattern, f, f);
    diagonal.push_back(pattern.triangle == SymmetricPattern::Triangle::upper
                           ? Places{x, y, y + 1, z, z + 1, z + 2}
                           : Places{x, x + 1, y, x + 2, y + 1, z});
  }
  for (Spring& s : springs) {
    s.fa = free_place[s.a];
    s.fb = free_place[s.b];
    if (s.fa < 0 || s.fb < 0) continue;
    const auto begin = block_begin(pattern, s.fa, s.fb);
    std::copy(begin.begin(), begin.end(), s.coupling);
  }
  for (const BendingStencil& s : problem.bending()) {
    Hinge hinge{};
    for (std::size_t i = 0, pair = 0; i < 4; ++i) {
      hinge.f[i] = free_place[s.vertex[i]];
      for (std::size_t j = 0; j < i; ++j, ++pair) {
        if (hinge.f[i] >= 0 && hinge.f[j] >= 0)
          hinge.coupling[pair] = block_begin(pattern, hinge.f[i], hinge.f[j]);
      }
    }
    hinges.push_back(hinge);
  }
}

}  // namespace inextensible
