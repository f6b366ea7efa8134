#include "solvers/systems/spring_hessian.h"

#include <utility>

namespace inextensible {
namespace {

std::vector<SpringHessian::Spring> springs_of(const Problem& problem, double stiffness) {
  std::vector<SpringHessian::Spring> springs;
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
  return springs;
}

Pairs coupled_vertices(const Problem& problem, const std::vector<SpringHessian::Spring>& springs) {
  Pairs pairs;
  for (const auto& s : springs) pairs.emplace_back(s.a, s.b);
  for (const BendingStencil& s : problem.bending()) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(s.vertex[i], s.vertex[j]);
    }
  }
  return pairs;
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

SpringHessian::SpringHessian(const Problem& problem, double stiffness, std::string_view wanted)
    : springs(springs_of(problem, stiffness)),
      matrix(problem, coupled_vertices(problem, springs), wanted, 3) {
  const SymmetricPattern& pattern = matrix.pattern;
  for (const int vertex : matrix.vertex) free_mass.push_back(problem.mass()[vertex]);
  for (int f = 0; f < static_cast<int>(matrix.vertex.size()); ++f) {
    const auto at = [&](int i, int j) { return pattern.place(3 * f + i, 3 * f + j); };
    diagonal.push_back({at(0, 0), at(0, 1), at(1, 1), at(0, 2), at(1, 2), at(2, 2)});
  }
  for (Spring& s : springs) {
    s.fa = matrix.place[s.a];
    s.fb = matrix.place[s.b];
    if (s.fa < 0 || s.fb < 0) continue;
    s.coupling = block_begin(pattern, s.fa, s.fb);
  }
  for (const BendingStencil& s : problem.bending()) {
    Hinge hinge{};
    for (std::size_t i = 0, pair = 0; i < 4; ++i) {
      hinge.f[i] = matrix.place[s.vertex[i]];
      for (std::size_t j = 0; j < i; ++j, ++pair) {
        if (hinge.f[i] >= 0 && hinge.f[j] >= 0)
          hinge.coupling[pair] = block_begin(pattern, hinge.f[i], hinge.f[j]);
      }
    }
    hinges.push_back(hinge);
  }
}

}  // namespace inextensible
