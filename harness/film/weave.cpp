#include "harness/film/weave.h"

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace harness {
namespace {

using Side = std::pair<int, int>;
using Cell = std::array<int, 2>;  // which weft yarn and which warp yarn a vertex lies on
using Quad = std::array<int, 4>;  // corners in turn

Side side(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Two triangles with a common side that is no edge are a quad of the cloth.
std::vector<Quad> quads_of(const Stage& stage, const std::set<Side>& edges) {
  std::map<Side, int> opposite;  // of a diagonal, the corner of its first triangle
  std::vector<Quad> quads;
  for (const auto& t : stage.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      if (edges.contains(side(a, b))) continue;
      const auto [found, first] = opposite.try_emplace(side(a, b), c);
      if (!first) quads.push_back({a, found->second, b, c});
    }
  }
  return quads;
}

// Numbers yarns from the first quad on, over common sides. Where a cloth closes to a ring, the
// numbers jump once.
std::vector<std::optional<Cell>> number_yarns(const std::vector<Quad>& quads, std::size_t vertices) {
  std::vector<std::optional<Cell>> cells(vertices);
  std::map<Side, std::vector<std::size_t>> beside;
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int k = 0; k < 4; ++k) beside[side(quads[q][k], quads[q][(k + 1) % 4])].push_back(q);
  std::vector<char> seen(quads.size(), 0);
  for (std::size_t first = 0; first < quads.size(); ++first) {
    if (seen[first]) continue;
    const std::array<Cell, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (int k = 0; k < 4; ++k)
      if (!cells[quads[first][k]]) cells[quads[first][k]] = corners[k];
    std::deque<std::size_t> queue{first};
    seen[first] = 1;
    while (!queue.empty()) {
      const Quad quad = quads[queue.front()];
      queue.pop_front();
      for (int k = 0; k < 4; ++k) {
        const int a = quad[k], b = quad[(k + 1) % 4];
        const Cell before_a = *cells[quad[(k + 3) % 4]], before_b = *cells[quad[(k + 2) % 4]];
        for (const std::size_t next : beside[side(a, b)]) {
          if (seen[next]) continue;
          seen[next] = 1;
          queue.push_back(next);
          const Quad& other = quads[next];
          for (int i = 0; i < 4; ++i) {
            const int from = other[i], left = other[(i + 3) % 4], right = other[(i + 1) % 4];
            if (from != a && from != b) continue;
            const int onward = left == a || left == b ? right : left;
            const Cell at = *cells[from], before = from == a ? before_a : before_b;
            if (!cells[onward]) cells[onward] = Cell{2 * at[0] - before[0], 2 * at[1] - before[1]};
          }
        }
      }
    }
  }
  return cells;
}

bool on_drawn_yarn(const std::optional<Cell>& a, const std::optional<Cell>& b, int every) {
  if (!a || !b) return false;
  return ((*a)[0] == (*b)[0] && (*a)[0] % every == 0) ||
         ((*a)[1] == (*b)[1] && (*a)[1] % every == 0);
}

}  // namespace

std::vector<std::uint8_t> drawn_sides(const Stage& stage, int every) {
  std::set<Side> edges;
  int last = -1;
  for (const auto& [a, b] : stage.edges) {
    edges.insert(side(a, b));
    last = std::max({last, a, b});
  }
  for (const auto& t : stage.triangles) last = std::max({last, t[0], t[1], t[2]});
  std::vector<std::optional<Cell>> cells;
  if (every > 1) cells = number_yarns(quads_of(stage, edges), static_cast<std::size_t>(last + 1));
  std::vector<std::uint8_t> sides;
  sides.reserve(stage.triangles.size());
  for (const auto& t : stage.triangles) {
    unsigned drawn = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (edges.contains(side(a, b)) && (every <= 1 || on_drawn_yarn(cells[a], cells[b], every)))
        drawn |= 1U << k;
    }
    sides.push_back(static_cast<std::uint8_t>(drawn));
  }
  return sides;
}

double mean_edge(const Stage& stage) {
  if (stage.rest_length.empty()) return 0;
  return std::accumulate(stage.rest_length.begin(), stage.rest_length.end(), 0.0) /
         static_cast<double>(stage.rest_length.size());
}

}  // namespace harness
