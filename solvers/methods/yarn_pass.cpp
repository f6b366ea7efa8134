// With J and W of one yarn alone, J W J^T is tridiagonal: a step of Newton's method on it costs
// little more than a pass over its edges and propagates along the whole yarn, for which passes need
// the square of its length. With g = d / l of a link and nu = 4 mu,
//   (w_a + w_b) |g|^2 nu + couplings -w g . g' nu' = C~,   x -= W J^T mu = w g nu / 2 at an end.
// C~ is what of C lies beyond the target, so that slack within it is not taken back. A yarn none
// of whose links is beyond the limit is left alone. Where a yarn lies straight between two pins
// the last pivot vanishes: pivots are kept from falling below a part of the diagonal.
//
// Yarns of one color are solved side by side, one in each lane of a vector (Thomas's algorithm in
// step). A link waits for the division of the one before it, so a lone yarn is
// eliminated from both ends at once (van der Vorst 1987), and the links at its middle last. Loops:
// two passes over links forwards and one back a yarn.
#include "solvers/methods/yarn_pass.h"

#include <map>
#include <tuple>

namespace inextensible {
namespace {

// ---- Yarns: one goes on through the edge opposite at a vertex, which shares no quad and no
// triangle with the edge before ----

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

// ---- A pass over yarns ----

constexpr double least_pivot = 1e-3;  // of the diagonal

// The halves of a yarn, both towards its middle; the first has a link more if their number is odd.
std::array<Yarn, 2> halves_of(const Yarn& yarn) {
  const auto middle = std::ssize(yarn.edges) - std::ssize(yarn.edges) / 2;
  return {{{{yarn.vertices.begin(), yarn.vertices.begin() + middle + 1},
            {yarn.edges.begin(), yarn.edges.begin() + middle},
            yarn.color},
           {{yarn.vertices.rbegin(), yarn.vertices.rend() - middle},
            {yarn.edges.rbegin(), yarn.edges.rend() - middle},
            yarn.color}}};
}

}  // namespace

YarnPass::YarnPass(const Problem& problem, double strain_limit, double target,
                   const ColoredEdges& places)
    : band_(strain_limit, target),
      target_low_(target * (PermissibleSquares(strain_limit).low - 1)),
      target_high_(target * (PermissibleSquares(strain_limit).high - 1)),
      places_(places) {
  const std::vector<Yarn> yarns = yarns_of(problem);
  for (auto first = yarns.begin(), end = first; first != yarns.end(); first = end) {
    while (end != yarns.end() && end - first < lanes && end->color == first->color) ++end;
    if (end - first == 1) {
      add_bundle(problem, halves_of(*first), true);
    } else {
      add_bundle(problem, {first, end}, false);
    }
  }
  crossing_ = !yarns.empty() && yarns.front().color != yarns.back().color;
  int longest = 0;
  for (const Bundle& b : bundles_) longest = std::max(longest, b.links);
  rows_.resize(static_cast<std::size_t>(longest) + 1, Row{});
}

// Null links come after a yarn, and before the half of one, whose last link is at the middle.
void YarnPass::add_bundle(const Problem& problem, std::span<const Yarn> yarns, bool joined) {
  const auto links = static_cast<int>(yarns.front().edges.size());  // the longest comes first
  bundles_.push_back(
      {links, static_cast<int>(place_.size()) / lanes, static_cast<int>(yarns.size()), joined});
  for (int i = 0; i <= links; ++i)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      // A lane without a yarn stays at the first one's begin, a short yarn at its end.
      const bool taken = lane < yarns.size();
      const Yarn& yarn = yarns[taken ? lane : 0];
      const int count = taken ? static_cast<int>(yarn.edges.size()) : 0;
      const int k = joined ? i - (links - count) : i;
      const int vertex = yarn.vertices[std::clamp(k, 0, count)];
      const bool link = k >= 0 && k < count;
      place_.push_back(places_.place(vertex));
      inverse_mass_.push_back(taken && k >= 0 && k <= count ? problem.inverse_mass()[vertex] : 0);
      rest_.push_back(link ? problem.rest_length()[yarn.edges[k]] : 0);
      inverse_rest_.push_back(link ? 1 / rest_.back() : 0);
    }
}

void YarnPass::take_middle_from(const Positions& x_start) {
  start_g_.resize(3 * place_.size());
  for (const Bundle& bundle : bundles_)
    for (int row = bundle.first; row < bundle.first + bundle.links; ++row) {
      const int* place = place_.data() + row * lanes;
      double* g = start_g_.data() + 3 * row * lanes;
      for (int i = 0; i < bundle.used; ++i) {
        const double* a = x_start.data() + 3 * places_.vertex(place[i]);
        const double* b = x_start.data() + 3 * places_.vertex(place[lanes + i]);
        for (int axis = 0; axis < 3; ++axis)
          g[axis * lanes + i] = (b[axis] - a[axis]) * inverse_rest_[row * lanes + i];
      }
    }
}

struct YarnPass::View {
  int links;
  bool joined;
  const int* place;
  const double *w, *l, *il;  // inverse masses; rest lengths and their inverses
  const double* start_g;     // where the middle of the step is asked for
  double* x[3];
  const double* normal[3];  // with contacts only
};

// g (or its middle) and C~ of every link; how many of each yarn are beyond the limit.
template <int used, bool middle>
void YarnPass::linearize(const View& yarns, double (&violated)[lanes]) {
  const double low = band_.low, high = band_.high, target_low = target_low_,
               target_high = target_high_;
  alignas(64) double here[3][lanes], next[3][lanes];
  const auto gather = [&](int vertex, double(&to)[3][lanes]) {
    const int* from = yarns.place + vertex * lanes;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < used; ++i) to[axis][i] = yarns.x[axis][from[i]];
  };
  gather(0, here);
  for (int k = 0; k < yarns.links; ++k) {
    Row& row = rows_[k + 1];
    gather(k + 1, next);
    const double *lk = yarns.l + k * lanes, *ilk = yarns.il + k * lanes;
    for (int i = 0; i < used; ++i) {
      const double g0 = (next[0][i] - here[0][i]) * ilk[i], g1 = (next[1][i] - here[1][i]) * ilk[i],
                   g2 = (next[2][i] - here[2][i]) * ilk[i];
      const double q = g0 * g0 + g1 * g1 + g2 * g2, strained = q - 1;
      const double kept = std::min(std::max(strained, target_low), target_high);
      if constexpr (middle) {
        const double* start = yarns.start_g + 3 * k * lanes + i;
        const double m0 = 0.5 * (start[0] + g0), m1 = 0.5 * (start[lanes] + g1),
                     m2 = 0.5 * (start[2 * lanes] + g2);
        const bool aligned = m0 * g0 + m1 * g1 + m2 * g2 > least_alignment * q;
        row.g[0][i] = aligned ? m0 : g0;
        row.g[1][i] = aligned ? m1 : g1;
        row.g[2][i] = aligned ? m2 : g2;
      } else {
        row.g[0][i] = g0;
        row.g[1][i] = g1;
        row.g[2][i] = g2;
      }
      row.c[i] = lk[i] * (strained - kept);
      violated[i] += (static_cast<int>(q < low) | static_cast<int>(!(q <= high))) && q != 0 ? 1 : 0;
      here[0][i] = next[0][i];
      here[1][i] = next[1][i];
      here[2][i] = next[2][i];
    }
  }
}

// J W J^T of each yarn, and its elimination from the first link to the last. solved: 1 for yarns
// that are projected, else 0.
template <int used, bool contact>
void YarnPass::eliminate(const View& yarns, const double (&solved)[lanes]) {
  const auto& normal = yarns.normal;
  for (int k = 0; k < yarns.links; ++k) {
    Row& row = rows_[k + 1];
    const Row& before = rows_[k];
    const double *wa = yarns.w + k * lanes, *wb = wa + lanes;
    alignas(64) double begin_along[lanes];
    if constexpr (contact) {
      const int *a = yarns.place + k * lanes, *b = a + lanes;
      for (int i = 0; i < used; ++i) {
        begin_along[i] = row.g[0][i] * normal[0][a[i]] + row.g[1][i] * normal[1][a[i]] +
                         row.g[2][i] * normal[2][a[i]];
        row.along[i] = row.g[0][i] * normal[0][b[i]] + row.g[1][i] * normal[1][b[i]] +
                       row.g[2][i] * normal[2][b[i]];
      }
    }
    for (int i = 0; i < used; ++i) {
      const double squared =
          row.g[0][i] * row.g[0][i] + row.g[1][i] * row.g[1][i] + row.g[2][i] * row.g[2][i];
      double own = (wa[i] + wb[i]) * squared;
      double coupled = row.g[0][i] * before.g[0][i] + row.g[1][i] * before.g[1][i] +
                       row.g[2][i] * before.g[2][i];
      if constexpr (contact) {  // w (I - n n^T) for w
        const double held =
            wa[i] * begin_along[i] * begin_along[i] + wb[i] * row.along[i] * row.along[i];
        own = std::max(own - held, least_pivot * own);
        coupled -= begin_along[i] * before.along[i];
      }
      const double diagonal = own > 0 ? own : 1;
      const double off = -wa[i] * coupled;
      const double factor = off * before.inverse_pivot[i];
      const double pivot = std::max(diagonal - factor * off, least_pivot * diagonal);
      row.c[i] = solved[i] * row.c[i] - factor * before.c[i];
      row.off[i] = off;
      row.inverse_pivot[i] = 1 / pivot;
    }
  }
}

// The multipliers of the last links of two halves, which share the vertex in the middle: both links
// lead there, so their coupling has the sign of its mass.
template <bool contact>
void YarnPass::join(const View& halves) {
  Row& row = rows_[halves.links];
  double coupled =
      row.g[0][0] * row.g[0][1] + row.g[1][0] * row.g[1][1] + row.g[2][0] * row.g[2][1];
  if constexpr (contact) coupled -= row.along[0] * row.along[1];
  const double off = halves.w[halves.links * lanes] * coupled;
  const double factor = off * row.inverse_pivot[0], diagonal = 1 / row.inverse_pivot[1];
  const double pivot = std::max(diagonal - factor * off, least_pivot * diagonal);
  row.c[1] = (row.c[1] - factor * row.c[0]) / pivot;
  row.c[0] = (row.c[0] - off * row.c[1]) * row.inverse_pivot[0];
  row.inverse_pivot[0] = row.inverse_pivot[1] = 1;
}

// Multipliers from the last link to the first, and x -= W J^T mu on the way.
template <int used>
void YarnPass::substitute(const View& yarns) const {
  alignas(64) double after[3][lanes] = {}, nu_after[lanes] = {}, off_after[lanes] = {};
  for (int k = yarns.links; k >= 0; --k) {
    const Row& row = rows_[k];
    const double* wb = yarns.w + k * lanes;
    alignas(64) double move[3][lanes];
    for (int i = 0; i < used; ++i) {
      const double nu = (row.c[i] - off_after[i] * nu_after[i]) * row.inverse_pivot[i];
      const double half = 0.5 * wb[i];
      for (int axis = 0; axis < 3; ++axis) {
        const double pull = nu * row.g[axis][i];
        move[axis][i] = half * (after[axis][i] - pull);
        after[axis][i] = pull;
      }
      nu_after[i] = nu;
      off_after[i] = row.off[i];
    }
    const int* to = yarns.place + k * lanes;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < used; ++i) yarns.x[axis][to[i]] += move[axis][i];
  }
}

// The first `used` lanes. A yarn none of whose links is beyond the limit stays as it is.
template <int used, bool contact, bool middle>
std::int64_t YarnPass::project(const View& yarns, WorkCounters& work) {
  alignas(64) double violated[lanes] = {};
  linearize<used, middle>(yarns, violated);
  double all = 0, solved[lanes];
  for (int i = 0; i < used; ++i) all += violated[i];
  if (all == 0) return 0;
  int projected = 0;
  for (int i = 0; i < used; ++i) {
    const bool beyond = yarns.joined || violated[i] > 0;
    solved[i] = beyond ? 1 : 0;
    projected += beyond ? 1 : 0;
  }
  if (yarns.joined) projected = 1;
  work.assemblies += projected;
  work.factorizations += projected;
  work.back_solves += projected;
  eliminate<used, contact>(yarns, solved);
  if (yarns.joined) join<contact>(yarns);
  substitute<used>(yarns);
  return static_cast<std::int64_t>(all);
}

std::int64_t YarnPass::project(ColoredEdges::Places& x, const ColoredEdges::Places* normals,
                               WorkCounters& work) {
  const bool middle = !start_g_.empty();
  std::int64_t violated = 0;
  for (const Bundle& bundle : bundles_) {
    const std::size_t first = static_cast<std::size_t>(bundle.first) * lanes;
    View yarns{bundle.links,
               bundle.joined,
               place_.data() + first,
               inverse_mass_.data() + first,
               rest_.data() + first,
               inverse_rest_.data() + first,
               middle ? start_g_.data() + 3 * first : nullptr,
               {x.col(0).data(), x.col(1).data(), x.col(2).data()},
               {}};
    for (int axis = 0; normals && axis < 3; ++axis) yarns.normal[axis] = normals->col(axis).data();
    const auto project_by = [&]<int used>() {
      return normals ? (middle ? project<used, true, true>(yarns, work)
                               : project<used, true, false>(yarns, work))
                     : (middle ? project<used, false, true>(yarns, work)
                               : project<used, false, false>(yarns, work));
    };
    violated += bundle.joined ? project_by.operator()<2>() : project_by.operator()<lanes>();
  }
  return violated;
}

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
