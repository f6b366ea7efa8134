#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "harness/film/pictures.h"

namespace harness {
namespace {

using Side = std::pair<int, int>;
using Cell = std::array<int, 2>;  // which weft yarn and which warp yarn a vertex lies on
using Quad = std::array<int, 4>;  // corners in turn

Side side(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Two triangles with a common side that is no edge are a quad of the cloth.
std::vector<Quad> quads_of(const FilmScene& stage, const std::set<Side>& edges) {
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

// Visits faces from the first of each connected part on, over common sides: begin(face) of the
// first, then reach(from, k, to) of each face beyond side k of one that was visited.
template <class Face, class Begin, class Reach>
void walk(const std::vector<Face>& faces, Begin begin, Reach reach) {
  constexpr std::size_t corners = std::tuple_size_v<Face>;
  std::map<Side, std::vector<std::size_t>> beside;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t k = 0; k < corners; ++k)
      beside[side(faces[i][k], faces[i][(k + 1) % corners])].push_back(i);
  std::vector<char> seen(faces.size(), 0);
  std::deque<std::size_t> queue;
  for (std::size_t first = 0; first < faces.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = 1;
    begin(first);
    for (queue.push_back(first); !queue.empty(); queue.pop_front()) {
      const Face face = faces[queue.front()];
      for (std::size_t k = 0; k < corners; ++k) {
        for (const std::size_t next : beside[side(face[k], face[(k + 1) % corners])]) {
          if (seen[next]) continue;
          seen[next] = 1;
          reach(face, k, next);
          queue.push_back(next);
        }
      }
    }
  }
}

using Cells = std::vector<std::optional<Cell>>;

// The quad beyond the side from corner k of `quad` to the next: its other corners lie as far
// beyond that side as those of `quad` lie before it.
void number_beyond(const Quad& quad, std::size_t k, const Quad& beyond, Cells& cells) {
  const int a = quad[k], b = quad[(k + 1) % 4];
  for (std::size_t i = 0; i < 4; ++i) {
    const int from = beyond[i], left = beyond[(i + 3) % 4], right = beyond[(i + 1) % 4];
    if (from != a && from != b) continue;
    const int onward = left == a || left == b ? right : left;
    if (cells[onward]) continue;
    const Cell at = *cells[from], before = *cells[quad[from == a ? (k + 3) % 4 : (k + 2) % 4]];
    cells[onward] = Cell{2 * at[0] - before[0], 2 * at[1] - before[1]};
  }
}

// Numbers yarns from 0, so that the outermost are drawn. Where a cloth closes to a ring, the
// numbers jump once.
Cells number_yarns(const std::vector<Quad>& quads, std::size_t vertices) {
  Cells cells(vertices);
  constexpr std::array<Cell, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  walk(
      quads,
      [&](std::size_t first) {
        for (std::size_t k = 0; k < 4; ++k)
          if (!cells[quads[first][k]]) cells[quads[first][k]] = corners[k];
      },
      [&](const Quad& quad, std::size_t k, std::size_t next) {
        number_beyond(quad, k, quads[next], cells);
      });
  for (std::size_t way = 0; way < 2; ++way) {
    int least = std::numeric_limits<int>::max();
    for (const auto& cell : cells)
      if (cell) least = std::min(least, (*cell)[way]);
    for (auto& cell : cells)
      if (cell) (*cell)[way] -= least;
  }
  return cells;
}

bool on_drawn_yarn(const std::optional<Cell>& a, const std::optional<Cell>& b, int every) {
  if (!a || !b) return false;
  return ((*a)[0] == (*b)[0] && (*a)[0] % every == 0) ||
         ((*a)[1] == (*b)[1] && (*a)[1] % every == 0);
}

}  // namespace

std::vector<std::array<int, 3>> oriented(std::vector<std::array<int, 3>> triangles) {
  walk(
      triangles, [](std::size_t) {},
      [&](const std::array<int, 3>& from, std::size_t k, std::size_t next) {
        auto& t = triangles[next];
        for (std::size_t i = 0; i < 3; ++i) {
          if (t[i] != from[k] || t[(i + 1) % 3] != from[(k + 1) % 3]) continue;
          std::swap(t[1], t[2]);  // it passes the side in the same direction
          break;
        }
      });
  return triangles;
}

std::vector<std::uint8_t> drawn_sides(const FilmScene& stage, int every) {
  std::set<Side> edges;
  int last = -1;
  for (const auto& [a, b] : stage.edges) {
    edges.insert(side(a, b));
    last = std::max({last, a, b});
  }
  for (const auto& t : stage.triangles) last = std::max({last, t[0], t[1], t[2]});
  Cells cells;
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

double mean_edge(const FilmScene& stage) {
  if (stage.rest_length.empty()) return 0;
  return std::accumulate(stage.rest_length.begin(), stage.rest_length.end(), 0.0) /
         static_cast<double>(stage.rest_length.size());
}

}  // namespace harness
