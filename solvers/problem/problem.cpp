#include "solvers/problem/problem.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace inextensible {
namespace {

template <class... Words>
[[noreturn]] void refuse(const Words&... words) {
  std::ostringstream text;
  (text << ... << words);
  throw std::invalid_argument(text.str());
}

// What is so small or so large that its inverse is not a normal number is a mistake.
void check_positive(const std::vector<double>& values, const char* what, const char* quantity) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (!(value > 0) || !std::isnormal(value) || !std::isnormal(1 / value))
      refuse(what, ' ', i, ": ", quantity, " is ", value, ", must be positive and finite");
  }
}

bool exists(int vertex, std::size_t vertices) {
  return vertex >= 0 && std::cmp_less(vertex, vertices);
}

bool negative_or_not_finite(double value) { return !(value >= 0) || !std::isfinite(value); }

void check_edges(const std::vector<Edge>& edges, std::size_t vertices, const char* what) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto [a, b] = edges[k];
    if (!exists(a, vertices) || !exists(b, vertices))
      refuse(what, ' ', k, ": joins vertices ", a, " and ", b, ", but there are only ", vertices);
    if (a == b) refuse(what, ' ', k, ": joins vertex ", a, " with itself");
  }
}

void check_shear(const Springs& shear, std::size_t vertices) {
  if (shear.rest_length.size() != shear.edges.size() ||
      shear.stiffness.size() != shear.edges.size())
    refuse("shear springs: edges, rest lengths and stiffnesses differ in number");
  check_edges(shear.edges, vertices, "shear spring");
  check_positive(shear.rest_length, "shear spring", "rest length");
  check_positive(shear.stiffness, "shear spring", "stiffness");
}

void check_bending(const Bending& bending, std::size_t vertices) {
  for (std::size_t s = 0; s < bending.size(); ++s) {
    for (const int vertex : bending[s].vertex) {
      if (!exists(vertex, vertices))
        refuse("bending stencil ", s, ": vertex ", vertex, " does not exist");
    }
    for (const double c : bending[s].coefficient) {
      if (!std::isfinite(c)) refuse("bending stencil ", s, ": a coefficient is not finite");
    }
    if (negative_or_not_finite(bending[s].stiffness))
      refuse("bending stencil ", s, ": its stiffness is negative or not finite");
  }
}

void check_limits(const std::vector<double>& scale, std::size_t edges) {
  if (!scale.empty() && scale.size() != edges)
    refuse("there are ", edges, " edges but ", scale.size(), " scales of their strain limit");
  for (std::size_t k = 0; k < scale.size(); ++k) {
    if (!(scale[k] >= 1 && std::isfinite(scale[k])))
      refuse("edge ", k, ": the scale of its strain limit is not a number of at least 1");
  }
}

void check_drag(const std::vector<double>& drag, std::size_t vertices) {
  if (!drag.empty() && drag.size() != vertices)
    refuse("there are ", vertices, " vertices but ", drag.size(), " drag coefficients");
  for (std::size_t i = 0; i < drag.size(); ++i) {
    if (negative_or_not_finite(drag[i]))
      refuse("vertex ", i, ": its drag is negative or not finite");
  }
}

// Stencils alike but for being shifted by some vertices follow each other in ascending order.
void put_in_order(Springs& springs) {
  std::vector<std::size_t> order(springs.edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t s) {
    const auto [a, b] = springs.edges[s];
    return std::pair(b - a, a);
  });
  Springs ordered;
  for (const std::size_t s : order) {
    ordered.edges.push_back(springs.edges[s]);
    ordered.rest_length.push_back(springs.rest_length[s]);
    ordered.stiffness.push_back(springs.stiffness[s]);
  }
  springs = std::move(ordered);
}

void put_in_order(Bending& bending) {
  std::ranges::stable_sort(bending, {}, [](const BendingStencil& stencil) {
    const auto [a, b, c, d] = stencil.vertex;
    return std::array{b - a, c - a, d - a, a};
  });
}

bool follows(const Edge& one, const Edge& next) {
  return next.a == one.a + 1 && next.b == one.b + 1;
}

bool follows(const BendingStencil& one, const BendingStencil& next) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (next.vertex[i] != one.vertex[i] + 1) return false;
  }
  return one.coefficient == next.coefficient && one.stiffness == next.stiffness;
}

template <class Stencils>
std::vector<std::size_t> runs_of(const Stencils& all) {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0 && follows(all[i - 1], all[i])) {
      ++runs.back();
    } else {
      runs.push_back(1);
    }
  }
  return runs;
}

}  // namespace

Problem::Problem(ProblemParts parts) : parts_(std::move(parts)) {
  const std::size_t n = parts_.mass.size();
  if (n == 0) refuse("a problem needs at least one vertex");
  if (parts_.rest_length.size() != parts_.edges.size())
    refuse("there are ", parts_.edges.size(), " edges but ", parts_.rest_length.size(),
           " rest lengths");
  check_positive(parts_.mass, "vertex", "mass");
  check_positive(parts_.rest_length, "edge", "rest length");
  check_edges(parts_.edges, n, "edge");
  if (!parts_.gravity.allFinite()) refuse("gravity is not finite");

  for (const double m : parts_.mass) inverse_mass_.push_back(1 / m);
  for (const int vertex : parts_.pinned) {
    if (!exists(vertex, n)) refuse("pinned vertex ", vertex, " does not exist");
    inverse_mass_[vertex] = 0;
  }
  for (std::size_t k = 0; k < parts_.edges.size(); ++k) {
    const auto [a, b] = parts_.edges[k];
    if (inverse_mass_[a] + inverse_mass_[b] == 0)
      refuse("edge ", k, ": both ends are pinned, so nothing can keep its length; leave it out");
  }
  if (parts_.shear) {
    check_shear(*parts_.shear, n);
    put_in_order(*parts_.shear);
    shear_runs_ = runs_of(parts_.shear->edges);
  }
  check_bending(parts_.bending, n);
  put_in_order(parts_.bending);
  bending_runs_ = runs_of(parts_.bending);
  check_limits(parts_.limit_scale, parts_.edges.size());
  check_drag(parts_.drag, n);
  if (parts_.body_motion && !parts_.collider) refuse("a body's motion without a collider");
  if (parts_.pins_follow_body && !parts_.body_motion)
    refuse("pins that follow a body that does not move");
  total_mass_ = std::accumulate(parts_.mass.begin(), parts_.mass.end(), 0.0);
  if (!parts_.rest_length.empty()) {
    const auto [shortest, longest] = std::ranges::minmax(parts_.rest_length);
    shortest_rest_length_ = shortest;
    longest_rest_length_ = longest;
  }
}

void check_state(const Problem& problem, const State& state) {
  const auto check = [&](const Positions& p, const char* quantity) {
    if (p.cols() != problem.vertices())
      refuse(quantity, " holds ", p.cols(), " vertices, the problem ", problem.vertices());
    for (Eigen::Index i = 0; i < p.cols(); ++i) {
      if (!p.col(i).allFinite()) refuse("vertex ", i, ": ", quantity, " is not finite");
    }
  };
  check(state.x, "position");
  check(state.v, "velocity");
}

}  // namespace inextensible
