#include "solvers/problem/edge_constraints.h"

#include <algorithm>
#include <cmath>

namespace inextensible {

void to_middle(const Eigen::Matrix3Xd& u_start, Eigen::Matrix3Xd& u) {
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    const Eigen::Vector3d middle = 0.5 * (u_start.col(k) + u.col(k));
    if (middle.dot(u.col(k)) > least_alignment * u.col(k).squaredNorm()) u.col(k) = middle;
  }
}

EdgeConstraints::EdgeConstraints(const Problem& problem, double strain_limit,
                                 std::vector<int> order)
    : permissible_low(PermissibleSquares(strain_limit).low),
      permissible_high(PermissibleSquares(strain_limit).high),
      order_(std::move(order)) {
  const std::size_t m = problem.constraints();
  for (auto* array : {&a, &b}) array->resize(m);
  for (auto* array : {&rest_length, &inverse_rest_length, &wa, &wb}) array->resize(m);
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t e = problem_edge(static_cast<int>(k));
    a[k] = problem.edges()[e].a;
    b[k] = problem.edges()[e].b;
    rest_length[k] = problem.rest_length()[e];
    inverse_rest_length[k] = 1 / rest_length[k];
    wa[k] = problem.inverse_mass()[a[k]];
    wb[k] = problem.inverse_mass()[b[k]];
    if (!problem.limit_scale().empty()) own_.emplace_back(problem.limit_scale()[e] * strain_limit);
  }
}

template <bool own>
bool EdgeConstraints::linearize_all(const Positions& x, Eigen::Matrix3Xd& u, Eigen::VectorXd& c,
                                    double target) const {
  double* uk = u.data();
  double* ck = c.data();
  const std::size_t m = count();
  int violations = 0;
  for (std::size_t k = 0; k < m; ++k, uk += 3) {
    const Scaled s = scaled(x.data(), k);
    uk[0] = 2 * s.x;
    uk[1] = 2 * s.y;
    uk[2] = 2 * s.z;
    ck[k] = rest_length[k] * (s.squared - 1);
    violations += outside<own>(s, k);
  }
  for (std::size_t k = 0; target > 0 && k < m; ++k) {
    const double least = target * (low<own>(k) - 1) * rest_length[k];
    const double most = target * (high<own>(k) - 1) * rest_length[k];
    ck[k] -= std::clamp(ck[k], least, most);
  }
  return violations == 0;
}

bool EdgeConstraints::linearize(const Positions& x, Eigen::Matrix3Xd& u, Eigen::VectorXd& c,
                                double target) const {
  return own_.empty() ? linearize_all<false>(x, u, c, target)
                      : linearize_all<true>(x, u, c, target);
}

void EdgeConstraints::gradient(const Positions& x, Eigen::Matrix3Xd& u) const {
  for (std::size_t k = 0; k < a.size(); ++k) {
    u.col(static_cast<Eigen::Index>(k)) = 2 * inverse_rest_length[k] * (x.col(b[k]) - x.col(a[k]));
  }
}

void EdgeConstraints::rate(const Eigen::Matrix3Xd& u, const Positions& v,
                           Eigen::VectorXd& c) const {
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    c[i] = u.col(i).dot(v.col(b[k]) - v.col(a[k]));
  }
}

bool EdgeConstraints::permissible(const Positions& x) const {
  return own_.empty() ? all_permissible<false>(x) : all_permissible<true>(x);
}

template <bool own>
bool EdgeConstraints::all_permissible(const Positions& x) const {
  constexpr std::size_t block =
      128;  // long enough to vectorize, short enough that a violation is found soon
  const std::size_t m = a.size();
  for (std::size_t begin = 0; begin < m; begin += block) {
    const std::size_t end = std::min(begin + block, m);
    int violations = 0;
    for (std::size_t k = begin; k < end; ++k) violations += outside<own>(scaled(x.data(), k), k);
    if (violations != 0) return false;
  }
  return true;
}

EdgeConstraints::Worst EdgeConstraints::worst(const Positions& x) const {
  Worst worst;
  double most = -1;
  for (std::size_t k = 0; k < a.size(); ++k) {
    double strain = (x.col(b[k]) - x.col(a[k])).norm() * inverse_rest_length[k] - 1;
    if (!std::isfinite(strain)) strain = std::numeric_limits<double>::infinity();
    const double over = std::abs(strain) / (own_.empty() ? 1 : std::sqrt(own_[k].high) - 1);
    if (over > most) {
      most = over;
      worst = {problem_edge(static_cast<int>(k)), strain};
    }
  }
  return worst;
}

void EdgeConstraints::apply(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu,
                            Positions& x) const {
  double* p = x.data();
  const double* uk = u.data();
  for (std::size_t k = 0; k < a.size(); ++k, uk += 3) {
    double* pa = p + 3 * a[k];
    double* pb = p + 3 * b[k];
    const double ma = wa[k] * mu[static_cast<Eigen::Index>(k)];
    const double mb = wb[k] * mu[static_cast<Eigen::Index>(k)];
    for (int i = 0; i < 3; ++i) {
      pa[i] += ma * uk[i];
      pb[i] -= mb * uk[i];
    }
  }
}

}  // namespace inextensible
