// The inextensibility constraints C_k(x) = |x_b - x_a|^2 / l_k - l_k and their gradient (Goldenthal
// et al. 2007, eqs. 1-2).
//
// Row k of J = grad C holds +u_k at b and -u_k at a, with u_k = 2 (x_b - x_a) / l_k; J is never
// stored, only u (3 x m).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/problem/problem.h"

namespace inextensible {

// Bounds on |d|^2 / l^2 of an edge within the strain limit.
struct PermissibleSquares {
  explicit PermissibleSquares(double strain_limit)
      : low(strain_limit < 1 ? (1 - strain_limit) * (1 - strain_limit) : 0),
        high((1 + strain_limit) * (1 + strain_limit)) {}
  double low, high;
};

// m . d / |d|^2 of an edge that has turned by 90 degrees in a step, m = (d_start + d) / 2 its
// middle: one that has turned further is taken as it is.
constexpr double least_alignment = 0.5;
// u (3 x m) at the end of a step becomes that of the middle, u_start at its start.
void to_middle(const Eigen::Matrix3Xd& u_start, Eigen::Matrix3Xd& u);

// The edges of a problem as arrays, in an order of the caller's choice (a fill-reducing one, say).
class EdgeConstraints {
 public:
  // order[k] is the problem's edge at place k; empty: the problem's own order.
  EdgeConstraints(const Problem& problem, double strain_limit, std::vector<int> order = {});

  int count() const { return static_cast<int>(a.size()); }
  int problem_edge(int k) const { return order_.empty() ? k : order_[k]; }

  // u (3 x m) and C (m) at x (3 x n), or how far C lies outside the fraction `target` of the
  // permissible band, 0 inside. Returns whether every edge is permissible; false on NaN.
  bool linearize(const Positions& x, Eigen::Matrix3Xd& u, Eigen::VectorXd& c,
                 double target = 0) const;

  // u alone: the start-of-step direction.
  void gradient(const Positions& x, Eigen::Matrix3Xd& u) const;

  // dC/dt = J v (m entries), J given by u, v 3 x n.
  void rate(const Eigen::Matrix3Xd& u, const Positions& v, Eigen::VectorXd& c) const;

  // Whether |strain| <= limit, or its own multiple of it, on every edge; leaves early when not.
  // False on NaN.
  bool permissible(const Positions& x) const;

  // The edge (problem's number) of largest |strain| over its limit, and its strain; one that is not
  // finite counts as infinite.
  struct Worst {
    int edge = -1;
    double strain = 0;
  };
  Worst worst(const Positions& x) const;

  // x -= W J^T mu, J given by u; mu (m entries) is h^2 lambda.
  void apply(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, Positions& x) const;

  std::vector<int> a, b;
  std::vector<double> rest_length, inverse_rest_length;
  std::vector<double> wa, wb;  // inverse masses of both ends
  // Bounds on |d|^2 / l^2; with limits that differ, of the tightest.
  double permissible_low, permissible_high;

 private:
  struct Scaled {  // d / l of an edge, and its square
    double x, y, z, squared;
  };
  Scaled scaled(const double* x, std::size_t k) const {
    const double *pa = x + 3 * a[k], *pb = x + 3 * b[k], il = inverse_rest_length[k];
    const double s0 = (pb[0] - pa[0]) * il, s1 = (pb[1] - pa[1]) * il, s2 = (pb[2] - pa[2]) * il;
    return {s0, s1, s2, s0 * s0 + s1 * s1 + s2 * s2};
  }
  // own: whether limits differ.
  template <bool own>
  double low(std::size_t k) const {
    return own ? own_[k].low : permissible_low;
  }
  template <bool own>
  double high(std::size_t k) const {
    return own ? own_[k].high : permissible_high;
  }
  template <bool own>
  bool outside(const Scaled& s, std::size_t k) const {  // the negation catches NaN
    return !(s.squared >= low<own>(k) && s.squared <= high<own>(k));
  }
  template <bool own>
  bool linearize_all(const Positions& x, Eigen::Matrix3Xd& u, Eigen::VectorXd& c,
                     double target) const;
  template <bool own>
  bool all_permissible(const Positions& x) const;

  std::vector<int> order_;
  std::vector<PermissibleSquares> own_;  // an edge; empty: limits do not differ
};

}  // namespace inextensible
