#include "harness/film/orientation.h"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

namespace harness {
namespace {

// Whether a triangle passes its side from a to b, and not from b to a.
bool passes(const std::array<int, 3>& t, int a, int b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (t[k] == a && t[(k + 1) % 3] == b) return true;
  return false;
}

}  // namespace

std::vector<std::array<int, 3>> oriented(std::vector<std::array<int, 3>> triangles) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> beside;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[i][k], triangles[i][(k + 1) % 3]);
      beside[{low, high}].push_back(i);
    }
  }
  std::vector<char> seen(triangles.size(), 0);
  std::deque<std::size_t> queue;
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = 1;
    for (queue.push_back(first); !queue.empty(); queue.pop_front()) {
      const std::array<int, 3> t = triangles[queue.front()];
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        for (const std::size_t next : beside[{std::min(a, b), std::max(a, b)}]) {
          if (seen[next]) continue;
          seen[next] = 1;
          if (passes(triangles[next], a, b)) std::swap(triangles[next][1], triangles[next][2]);
          queue.push_back(next);
        }
      }
    }
  }
  return triangles;
}

}  // namespace harness
