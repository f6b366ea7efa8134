#include "solvers/systems/spring_hessian.h"

#include <algorithm>

#include "solvers/linear/spd_solvers.h"

namespace inextensible {
namespace {

// Whether vertices are numbered along chains: every spring joins one to the next.
bool chains(const Pairs& pairs) {
  return std::all_of(pairs.begin(), pairs.end(), [](const std::pair<int, int>& pair) {
    return std::abs(pair.first - pair.second) == 1;
  });
}

// Where each column of the block that couples i and j begins among a matrix's values.
std::array<int, 3> block_begin(const SymmetricPattern& pattern, int i, int j) {
  if (pattern.triangle ==
      (i < j ? SymmetricPattern::Triangle::lower : SymmetricPattern::Triangle::upper))
    std::swap(i, j);
  const auto at = [&](int c) { return pattern.place(3 * i, 3 * j + c); };
  return {at(0), at(1), at(2)};
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
  Pairs pairs = coupled_pairs(problem);
  // Instructions of a second of plain Newton, in 1e6: on the chain of 80, block_tridiagonal 23,
  // multifrontal 54, cholmod_simplicial 79; on the drape of 21 x 21, multifrontal 3400,
  // cholmod_supernodal 5100, cholmod_simplicial 10000.
  linear_solver = wanted != "auto" ? std::string(wanted)
                  : chains(pairs)  ? "block_tridiagonal"
                                   : "multifrontal";
  const SpdSolverRow& row = spd_solver(linear_solver);
  if (row.takes == Takes::block_tridiagonal) {
    // Where one chain ends and the next begins the matrix holds zeros.
    for (int f = 1; f < n; ++f) pairs.emplace_back(f - 1, f);
  } else {
    order_vertices(pairs);
    pairs = coupled_pairs(problem);
  }
  for (const int vertex : free_vertex) free_mass.push_back(problem.mass()[vertex]);
  SymmetricPattern pattern = in_blocks(pattern_of(n, pairs, row.triangle), 3);
  locate_blocks(problem, pattern);
  entries = pattern.entries();
  solver = make_spd_solver(linear_solver, std::move(pattern));
}

// Coupled pairs of free vertices, by their place among these.
Pairs SpringHessian::coupled_pairs(const Problem& problem) const {
  Pairs pairs;
  const auto add = [&](int a, int b) {
    const int f = free_place[a], g = free_place[b];
    if (f >= 0 && g >= 0 && f != g) pairs.emplace_back(f, g);
  };
  for (const Spring& s : springs) add(s.a, s.b);
  for (const BendingStencil& s : problem.bending()) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) add(s.vertex[i], s.vertex[j]);
    }
  }
  return pairs;
}

void SpringHessian::order_vertices(const Pairs& pairs) {
  const std::vector<int> order = fill_reducing_order(
      pattern_of(static_cast<int>(free_vertex.size()), pairs, SymmetricPattern::Triangle::upper));
  std::vector<int> ordered(free_vertex.size());
  for (std::size_t f = 0; f < ordered.size(); ++f) {
    ordered[f] = free_vertex[order[f]];
    free_place[ordered[f]] = static_cast<int>(f);
  }
  free_vertex = std::move(ordered);
}

void SpringHessian::locate_blocks(const Problem& problem, const SymmetricPattern& pattern) {
  for (int f = 0; f < static_cast<int>(free_vertex.size()); ++f) {
    const auto at = [&](int i, int j) { return pattern.place(3 * f + i, 3 * f + j); };
    diagonal.push_back({at(0, 0), at(0, 1), at(1, 1), at(0, 2), at(1, 2), at(2, 2)});
  }
  for (Spring& s : springs) {
    s.fa = free_place[s.a];
    s.fb = free_place[s.b];
    if (s.fa < 0 || s.fb < 0) continue;
    s.coupling = block_begin(pattern, s.fa, s.fb);
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
