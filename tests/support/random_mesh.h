// Random problems for property tests; every test prints the seed it failed with (for_seeds).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "solvers/problem/problem.h"
#include "support/effort.h"

namespace inextensible::testing {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Eigen::Vector3d random_vector(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

inline Eigen::MatrixXd random_matrix(Random& random, Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(random, -1, 1); });
}

// Runs test(random, seed) for `count` seeds, an eighth with sanitizers; a failure names its seed.
template <class Test>
void for_seeds(std::uint64_t count, const Test& test) {
  for (std::uint64_t seed = 0; seed < trials(count); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    test(random, seed);
  }
}

struct RandomMesh {
  std::shared_ptr<const Problem> problem;
  Positions x;  // at rest: every edge has its rest length
};

// The parts of a problem without shear, bending, drag and obstacle, to make another from.
inline ProblemParts parts_of(const Problem& problem) {
  ProblemParts parts;
  parts.mass = problem.mass();
  parts.pinned = problem.pinned();
  parts.edges = problem.edges();
  parts.rest_length = problem.rest_length();
  parts.gravity = problem.gravity();
  return parts;
}

// At rest at x where edges join vertices; without gravity, so that momentum can be checked.
inline ProblemParts parts_at_rest(const Positions& x, std::vector<Edge> edges,
                                  std::vector<double> mass, std::vector<int> pinned = {}) {
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass = std::move(mass);
  parts.pinned = std::move(pinned);
  for (const Edge e : edges) parts.rest_length.push_back((x.col(e.b) - x.col(e.a)).norm());
  parts.edges = std::move(edges);
  return parts;
}

// A crumpled quad grid with unequal edge lengths and masses (a decade apart); `pinned` pins.
inline RandomMesh random_mesh(Random& random, int rows, int columns, int pinned) {
  const int n = rows * columns;
  Positions x(3, n);
  std::vector<double> mass;
  std::vector<Edge> edges;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const int v = i * columns + j;
      x.col(v) << j + uniform(random, -0.2, 0.2), uniform(random, -0.3, 0.3),
          i + uniform(random, -0.2, 0.2);
      mass.push_back(uniform(random, 0.1, 1));
      if (j > 0) edges.push_back({v - 1, v});
      if (i > 0) edges.push_back({v, v - columns});  // both orientations occur
    }
  std::vector<int> pins(n);
  std::iota(pins.begin(), pins.end(), 0);
  std::shuffle(pins.begin(), pins.end(), random);
  pins.resize(pinned);
  const auto is_pinned = [&](int v) { return std::ranges::count(pins, v) > 0; };
  std::erase_if(edges, [&](Edge e) { return is_pinned(e.a) && is_pinned(e.b); });
  return {std::make_shared<const Problem>(parts_at_rest(x, edges, mass, pins)), x};
}

// A random tree of n vertices with `extra` further edges, none twice; positions random in a cube,
// at rest; masses log-uniform in [lightest, 1]; the first `pinned` vertices pinned. Zero gravity.
// With extra well below 2 n the gradients are independent (a generic framework in space).
inline RandomMesh random_graph(Random& random, int n, int extra, int pinned, double lightest) {
  const Positions x = random_matrix(random, 3, n);
  std::vector<double> mass;
  for (int v = 0; v < n; ++v) mass.push_back(std::pow(lightest, uniform(random, 0, 1)));
  std::vector<int> pins(pinned);
  std::iota(pins.begin(), pins.end(), 0);
  std::vector<Edge> edges;
  std::set<std::pair<int, int>> taken;
  const auto join = [&](int a, int b) {
    if (a == b || (a < pinned && b < pinned) || !taken.insert(std::minmax(a, b)).second)
      return false;
    edges.push_back({a, b});
    return true;
  };
  const auto vertex = [&](int below) {
    return static_cast<int>(random() % static_cast<std::uint64_t>(below));
  };
  for (int v = std::max(pinned, 1); v < n; ++v) join(v, vertex(v));
  for (int added = 0; added < extra;) added += join(vertex(n), vertex(n));
  return {std::make_shared<const Problem>(parts_at_rest(x, edges, mass, pins)), x};
}

// Some hairs in one problem, their edges in random directions: pinned at one end, between, or
// nowhere. At rest in random shape, masses log-uniform in [lightest, 1]. `twice`: some edges are.
inline RandomMesh random_chains(Random& random, int chains, double lightest = 1e-3,
                                bool twice = false) {
  std::vector<double> mass;
  std::vector<int> pins;
  std::vector<Edge> edges;
  for (int chain = 0; chain < chains; ++chain) {
    const int first = static_cast<int>(mass.size()), length = 1 + static_cast<int>(random() % 12);
    const int pin = first + static_cast<int>(random() % 13);
    for (int v = first; v < first + length; ++v) {
      mass.push_back(std::pow(lightest, uniform(random, 0, 1)));
      if (v == pin) pins.push_back(v);
      if (v > first) edges.push_back(random() % 2 ? Edge{v - 1, v} : Edge{v, v - 1});
      if (twice && v > first && random() % 4 == 0) edges.push_back({v - 1, v});
    }
  }
  std::shuffle(edges.begin(), edges.end(), random);
  const Positions x = random_matrix(random, 3, std::ssize(mass));
  return {std::make_shared<const Problem>(parts_at_rest(x, edges, mass, pins)), x};
}

// Free vertices moved by up to `size` in each coordinate.
inline Positions perturbed(Random& random, const RandomMesh& mesh, double size) {
  Positions x = mesh.x;
  for (Eigen::Index v = 0; v < x.cols(); ++v)
    if (mesh.problem->inverse_mass()[v] > 0) x.col(v) += random_vector(random, size);
  return x;
}

// J (m x 3n), dense, row by row from its definition. Pinned columns included.
inline Eigen::MatrixXd dense_gradient(const Problem& problem, const Positions& x) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(problem.constraints(), 3 * x.cols());
  for (int k = 0; k < problem.constraints(); ++k) {
    const auto [a, b] = problem.edges()[k];
    const Eigen::RowVector3d u = 2 / problem.rest_length()[k] * (x.col(b) - x.col(a)).transpose();
    jacobian.block<1, 3>(k, 3 * a) = -u;
    jacobian.block<1, 3>(k, 3 * b) = u;
  }
  return jacobian;
}

// W J^T at x (3n x m), dense; J(y) times it is J W J^T, or SHAKE's matrix.
inline Eigen::MatrixXd dense_moves(const Problem& problem, const Positions& x) {
  const auto w = Eigen::RowVectorXd::Map(problem.inverse_mass().data(), problem.vertices());
  return w.replicate(3, 1).reshaped().asDiagonal() * dense_gradient(problem, x).transpose();
}

}  // namespace inextensible::testing
