// A yarn goes on through the edge opposite at a vertex: the two share no quad and no triangle.
#include <map>
#include <tuple>

#include "solvers/methods/yarn_pass.h"

namespace inextensible {
namespace {

// A neighbour of a vertex and the edge to it; a vertex lists them in the order of the edges.
struct Neighbour {
  int vertex, edge;
};
using Neighbours = std::vector<std::vector<Neighbour>>;

bool joined(const Neighbours& at, int a, int b) {
  return std::ranges::any_of(at[a], [b](const Neighbour& n) { return n.vertex == b; });
}

// Whether the edges from v to a and to b are sides of one triangle or quad.
bool share_a_face(const Neighbours& at, int v, int a, int b) {
  if (a == b || joined(at, a, b)) return true;
  return std::ranges::any_of(
      at[a], [&](const Neighbour& n) { return n.vertex != v && joined(at, n.vertex, b); });
}

// Which end of an edge v is, and the vertex at the other.
int end_of(const Edge& edge, int v) { return edge.a == v ? 0 : 1; }
int other_end(const Edge& edge, int v) { return edge.a == v ? edge.b : edge.a; }

// The edges that continue each edge at its ends a and b; -1: none.
std::vector<std::array<int, 2>> continuations(const Problem& problem, const Neighbours& at) {
  std::vector<std::array<int, 2>> next(problem.constraints(), {-1, -1});
  for (int v = 0; v < problem.vertices(); ++v) {
    const auto after = [&](int edge) -> int& {
      return next[edge][end_of(problem.edges()[edge], v)];
    };
    // In the order of the mesh, each edge takes the first free one that lies opposite.
    for (auto one = at[v].begin(); one != at[v].end(); ++one) {
      if (after(one->edge) >= 0) continue;
      const auto other = std::find_if(one + 1, at[v].end(), [&](const Neighbour& n) {
        return after(n.edge) < 0 && !share_a_face(at, v, one->vertex, n.vertex);
      });
      if (other == at[v].end()) continue;
      after(one->edge) = other->edge;
      after(other->edge) = one->edge;
    }
  }
  return next;
}

}  // namespace

std::vector<Yarn> yarns_of(const Problem& problem) {
  Neighbours at(problem.vertices());
  for (int k = 0; k < problem.constraints(); ++k) {
    const auto [a, b] = problem.edges()[k];
    at[a].push_back({b, k});
    at[b].push_back({a, k});
  }
  const auto next = continuations(problem, at);
  std::vector<bool> used(problem.constraints(), false);
  std::vector<bool> seen(problem.vertices(), false);
  std::vector<Yarn> yarns;
  // From an edge on, beginning at its end v, until the yarn ends or meets itself.
  const auto follow = [&](int edge, int v) {
    Yarn yarn{{v}, {}, 0};
    seen[v] = true;
    while (edge >= 0 && !used[edge]) {
      const int to = other_end(problem.edges()[edge], v);
      if (seen[to]) break;
      used[edge] = seen[to] = true;
      yarn.edges.push_back(edge);
      yarn.vertices.push_back(to);
      edge = next[edge][end_of(problem.edges()[edge], to)];
      v = to;
    }
    for (const int vertex : yarn.vertices) seen[vertex] = false;
    if (!yarn.edges.empty()) yarns.push_back(std::move(yarn));
  };
  for (int k = 0; k < problem.constraints(); ++k) {  // those that have an end
    const Edge e = problem.edges()[k];
    if (!used[k] && next[k][0] < 0) follow(k, e.a);
    if (!used[k] && next[k][1] < 0) follow(k, e.b);
  }
  for (int k = 0; k < problem.constraints(); ++k) {  // rings, and what was cut off
    if (!used[k]) follow(k, problem.edges()[k].a);
  }
  Palette palette(problem.vertices());
  std::map<int, std::ptrdiff_t> edges_of;
  for (Yarn& yarn : yarns) {
    yarn.color = palette.take(yarn.vertices);
    edges_of[yarn.color] += std::ssize(yarn.edges);
  }
  std::ranges::stable_sort(yarns, {}, [&](const Yarn& yarn) {
    return std::tuple(-edges_of[yarn.color], yarn.color, -std::ssize(yarn.edges));
  });
  return yarns;
}

}  // namespace inextensible
