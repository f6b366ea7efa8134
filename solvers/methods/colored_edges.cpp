// Numbering. Cloth is woven row after row: its edges join v with v + 1 or with v + stride. Folded
// at that stride, vertex numbers are rows and columns; even and odd rows and columns go to separate
// lanes (red-black ordering in both directions). Edges of one direction and parity then join two
// lanes at one distance. A chain is a single row; elsewhere this is a numbering as good as any.
//
// Coloring. Edges that leave one lane by one distance are of one kind. A kind that is a matching
// takes the first color that all of it fits, larger kinds first; other edges take theirs one by
// one. That makes four colors on cloth, two on a chain; more cost nothing, short blocks do.
//
// Blocks. In a kind, runs of consecutive places become blocks, across gaps of up to `bridge`. Edges
// outside of runs are listed, in one more block of their color.
#include "solvers/methods/colored_edges.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <tuple>

namespace inextensible {
namespace {

constexpr int bridge = 4;  // this many fillers cost less than ending a block
constexpr std::size_t least_run = ColoredEdges::width / 2;  // shorter ones are listed

int round_up(int count, int multiple) { return (count + multiple - 1) / multiple * multiple; }

// The most frequent difference of vertex numbers but 1, if one edge in eight has it.
int stride_of(const Problem& problem) {
  std::map<int, int> edges_with;
  for (const Edge& e : problem.edges()) ++edges_with[std::abs(e.b - e.a)];
  edges_with.erase(1);
  const auto most = std::ranges::max_element(edges_with, {}, [](auto& p) { return p.second; });
  const bool woven = most != edges_with.end() && 8 * most->second >= problem.constraints();
  return woven ? most->first : problem.vertices();
}

}  // namespace

struct ColoredEdges::Link {
  int lane, distance;  // from a to b
  int a, b;            // places, a < b
  int edge;
  bool turned;
  int color;

  bool same_kind(const Link& other) const {
    return lane == other.lane && distance == other.distance;
  }
};

int Palette::take(std::span<const int> places) {
  int color = 0;
  while (std::ranges::any_of(places, [&](int place) { return taken_[place].contains(color); }))
    ++color;
  for (const int place : places) taken_[place].insert(color);
  return color;
}

ColoredEdges::ColoredEdges(const Problem& problem) {
  number_vertices(problem);
  std::vector<Link> links = links_by_kind(problem);
  color(links);
  make_blocks(links);
}

void ColoredEdges::number_vertices(const Problem& problem) {
  const int n = problem.vertices(), stride = stride_of(problem);
  const int rows = (n + stride - 1) / stride, half_row = (stride + 1) / 2;
  // `width` more than needed, for the fillers at the end of a block.
  lane_ = round_up(half_row * ((rows + 1) / 2) + width, 8);
  vertex_.assign(lane_ * (rows > 1 ? 4 : 2), 0);
  for (int v = 0; v < n; ++v) {
    const int i = v / stride, j = v % stride;
    place_.push_back((2 * (i % 2) + j % 2) * lane_ + i / 2 * half_row + j / 2);
    vertex_[place_.back()] = v;
    if (problem.inverse_mass()[v] > 0) moving_.push_back(v);
  }
}

std::vector<ColoredEdges::Link> ColoredEdges::links_by_kind(const Problem& problem) const {
  std::vector<Link> links;
  for (int k = 0; k < problem.constraints(); ++k) {
    const Edge e = problem.edges()[k];
    const int p = place_[e.a], q = place_[e.b], a = std::min(p, q);
    links.push_back({a / lane_, std::abs(q - p), a, std::max(p, q), k, p > q, 0});
  }
  std::ranges::sort(links, {}, [](const Link& link) {
    return std::tuple(link.lane, link.distance, link.a, link.edge);
  });
  return links;
}

void ColoredEdges::color(std::vector<Link>& links) const {
  using Kind = std::span<Link>;
  std::vector<Kind> kinds;
  for (auto begin = links.begin(); begin != links.end(); begin += std::ssize(kinds.back())) {
    kinds.emplace_back(begin, std::find_if(begin, links.end(), [&](const Link& link) {
                         return !link.same_kind(*begin);
                       }));
  }
  std::ranges::stable_sort(kinds, std::ranges::greater{}, std::ranges::size);
  Palette palette(vertex_.size());
  for (const Kind kind : kinds) {
    std::vector<int> ends;
    for (const Link& link : kind) ends.insert(ends.end(), {link.a, link.b});
    std::ranges::sort(ends);
    const bool matching = std::ranges::adjacent_find(ends) == ends.end();
    if (kind.size() >= least_run && matching) {
      const int color = palette.take(ends);
      for (Link& link : kind) link.color = color;
    } else {
      for (Link& link : kind) link.color = palette.take(std::array{link.a, link.b});
    }
  }
}

void ColoredEdges::make_blocks(std::vector<Link>& links) {
  std::ranges::stable_sort(links, {}, &Link::color);
  std::vector<Link> single;
  for (auto begin = links.begin(), end = begin; begin != links.end(); begin = end) {
    // Both ends of a block, fillers included, must be different places.
    const auto goes_on = [&] {
      return end->color == begin->color && end->same_kind(*begin) &&
             end->a - (end - 1)->a <= 1 + bridge &&
             round_up(end->a - begin->a + 1, width) <= begin->distance;
    };
    for (++end; end != links.end() && goes_on();) ++end;
    if (end - begin >= std::ptrdiff_t{least_run} && width <= begin->distance) {
      add_run({begin, end});
    } else {
      single.insert(single.end(), begin, end);
    }
    if (end == links.end() || end->color != begin->color) {
      add_list(single);
      single.clear();
    }
  }
}

void ColoredEdges::add_entry(int a, int b, int edge, bool turned) {
  a_.push_back(a);
  b_.push_back(b);
  problem_edge_.push_back(edge);
  turned_.push_back(turned);
}

void ColoredEdges::add_run(std::span<const Link> links) {
  const int first_a = links.front().a, first_b = links.front().b;
  const int count = round_up(links.back().a - first_a + 1, width);
  blocks_.push_back({entries(), count, links.front().color, true});
  auto link = links.begin();
  for (int i = 0; i < count; ++i) {
    if (link != links.end() && link->a == first_a + i) {
      add_entry(link->a, link->b, link->edge, link->turned);
      ++link;
    } else {
      add_entry(first_a + i, first_b + i, -1, false);
    }
  }
}

void ColoredEdges::add_list(std::span<const Link> links) {
  if (links.empty()) return;
  const int first = entries(), count = round_up(static_cast<int>(links.size()), width);
  blocks_.push_back({first, count, links.front().color, false});
  for (const Link& link : links) add_entry(link.a, link.b, link.edge, link.turned);
  const int nowhere = static_cast<int>(vertex_.size()) - 1;
  while (entries() < first + count) add_entry(nowhere, nowhere, -1, false);
}

void ColoredEdges::load(const Positions& x, Places& places) const {
  double* to[3] = {places.col(0).data(), places.col(1).data(), places.col(2).data()};
  for (std::size_t k = 0; k < vertex_.size(); ++k) {
    const double* from = x.data() + 3 * vertex_[k];
    for (int axis = 0; axis < 3; ++axis) to[axis][k] = from[axis];
  }
}

void ColoredEdges::store(const Places& places, Positions& x) const {
  const double* from[3] = {places.col(0).data(), places.col(1).data(), places.col(2).data()};
  for (const int v : moving_) {
    double* to = x.data() + 3 * v;
    for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis][place_[v]];
  }
}

}  // namespace inextensible
