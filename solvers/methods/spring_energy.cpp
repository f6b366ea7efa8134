#include "solvers/methods/spring_energy.h"

#include "solvers/problem/forces.h"

namespace inextensible {
namespace {

// A held vertex's stiffness along the normal, over the rest of its diagonal block.
constexpr double stiff_normal = 1e6;

Pairs coupled_vertices(const Problem& problem) {
  Pairs pairs;
  for (const auto [a, b] : problem.edges()) pairs.emplace_back(a, b);
  if (const Springs* shear = problem.shear())
    for (const auto [a, b] : shear->edges) pairs.emplace_back(a, b);
  for (const BendingStencil& s : problem.bending())
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(s.vertex[i], s.vertex[j]);
  return pairs;
}

// Where each column of the block that couples free vertices i and j begins among a matrix's values.
std::array<int, 3> block_begin(const SymmetricPattern& pattern, int i, int j) {
  if (i < 0 || j < 0) return {};
  if (pattern.triangle ==
      (i < j ? SymmetricPattern::Triangle::lower : SymmetricPattern::Triangle::upper))
    std::swap(i, j);
  const auto at = [&](int c) { return pattern.place(3 * i, 3 * j + c); };
  return {at(0), at(1), at(2)};
}

}  // namespace

SpringEnergy::SpringEnergy(const Problem& problem, double stiffness)
    : problem_(problem), matrix_(problem, coupled_vertices(problem), "auto", 3) {
  const SymmetricPattern& pattern = matrix_.pattern;
  const int free = static_cast<int>(matrix_.vertex.size());
  for (int f = 0; f < free; ++f) {
    const auto at = [&](int i, int j) { return pattern.place(3 * f + i, 3 * f + j); };
    diagonal_.push_back({at(0, 0), at(0, 1), at(1, 1), at(0, 2), at(1, 2), at(2, 2)});
  }
  const auto add = [&](Edge e, double rest, double k) {
    const int fa = matrix_.place[e.a], fb = matrix_.place[e.b];
    springs_.push_back({e.a, e.b, fa, fb, rest, k, block_begin(pattern, fa, fb)});
  };
  for (std::size_t k = 0; k < problem.edges().size(); ++k)
    add(problem.edges()[k], problem.rest_length()[k], stiffness / problem.rest_length()[k]);
  if (const Springs* shear = problem.shear())
    for (std::size_t k = 0; k < shear->edges.size(); ++k)
      add(shear->edges[k], shear->rest_length[k], shear->stiffness[k]);
  for (const BendingStencil& s : problem.bending()) {
    Hinge hinge{};
    for (std::size_t i = 0, pair = 0; i < 4; ++i) {
      hinge.f[i] = matrix_.place[s.vertex[i]];
      for (std::size_t j = 0; j < i; ++j, ++pair)
        hinge.coupling[pair] = block_begin(pattern, hinge.f[i], hinge.f[j]);
    }
    hinges_.push_back(hinge);
  }
  inertial_.resize(3, problem.vertices());
  if (problem.has_drag()) before_.resize(3, problem.vertices());
  if (problem.contact_inside()) reaction_.resize(problem.vertices());
  gradient_.resize(3 * free);
  pull_before_.assign(springs_.size(), 0.0);
}

void SpringEnergy::begin(const State& state, double h) {
  h_ = h;
  if (problem_.has_drag()) before_ = state.x;
  free_flight(problem_, state, h, h * h, inertial_);
  pull_ = pull_before_;
}

double SpringEnergy::value(const Positions& x) const {
  double inertia = 0, potential = 0;
  for (const int v : matrix_.vertex)
    inertia += problem_.mass()[v] * (x.col(v) - inertial_.col(v)).squaredNorm();
  if (problem_.has_drag()) {  // backward Euler's drag is the gradient of h / 2 |x - x^n|_D^2
    for (const int v : matrix_.vertex)
      inertia += h_ * problem_.drag(v) * (x.col(v) - before_.col(v)).squaredNorm();
  }
  potential += 2 * bending_energy(problem_.bending(), x);
  const double* p = x.data();
  for (const Spring& s : springs_) {
    const double* pa = p + 3 * s.a;
    const double* pb = p + 3 * s.b;
    const double d0 = pb[0] - pa[0], d1 = pb[1] - pa[1], d2 = pb[2] - pa[2];
    const double elongation = std::sqrt(d0 * d0 + d1 * d1 + d2 * d2) - s.rest;
    potential += s.k * elongation * elongation;
  }
  return 0.5 * (inertia + h_ * h_ * potential);
}

void SpringEnergy::assemble(const Positions& x, const Contacts* contacts, bool matrix) {
  double* value = matrix_.solver->values();
  if (matrix) std::fill(value, value + matrix_.pattern.entries(), 0.0);
  const double* p = x.data();
  double* g = gradient_.data();
  const double h = h_, square = h * h;  // in registers
  for (std::size_t f = 0; f < matrix_.vertex.size(); ++f) {
    const int v = matrix_.vertex[f];
    const double mass = problem_.mass()[v];
    const double drag = problem_.has_drag() ? h * problem_.drag(v) : 0;
    for (int i = 0; i < 3; ++i) {
      g[3 * f + i] = mass * (x(i, v) - inertial_(i, v));
      if (problem_.has_drag()) g[3 * f + i] += drag * (x(i, v) - before_(i, v));
    }
    const Places& at = diagonal_[f];
    if (matrix) value[at.xx] = value[at.yy] = value[at.zz] = mass + drag;
  }
  assemble_bending(x, matrix);
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Spring& s = springs_[k];
    const double* pa = p + 3 * s.a;
    const double* pb = p + 3 * s.b;
    const double dx = pb[0] - pa[0], dy = pb[1] - pa[1], dz = pb[2] - pa[2];
    const double squared = dx * dx + dy * dy + dz * dz;
    const double inverse_length = squared > 0 ? 1 / std::sqrt(squared) : 0;
    const double stiffness = square * s.k;
    // Over the spring's vector; one of length zero has no direction and no force.
    const double pull = squared > 0 ? stiffness * (1 - s.rest * inverse_length) : 0;
    const auto push = [&](int f, double signed_pull) {
      double* gf = g + 3 * f;
      gf[0] += signed_pull * dx, gf[1] += signed_pull * dy, gf[2] += signed_pull * dz;
    };
    if (s.fa >= 0) push(s.fa, -pull);
    if (s.fb >= 0) push(s.fb, pull);
    if (!matrix) continue;
    // The projected transverse stiffness.
    const double transverse = std::clamp(square * pull_[k], 0.0, stiffness);
    add_block(s, {dx, dy, dz}, (stiffness - transverse) * (inverse_length * inverse_length),
              transverse);
  }
  if (contacts) hold_in_planes(*contacts, matrix);
}

// along d d^T + transverse I: both diagonal blocks, and the coupling with the opposite sign.
inline void SpringEnergy::add_block(const Spring& s, const std::array<double, 3>& d, double along,
                                    double transverse) {
  double* value = matrix_.solver->values();
  const auto [dx, dy, dz] = d;
  const double xx = along * dx * dx + transverse, xy = along * dx * dy, xz = along * dx * dz,
               yy = along * dy * dy + transverse, yz = along * dy * dz,
               zz = along * dz * dz + transverse;
  const auto add = [&](int f) {
    const Places& at = diagonal_[f];
    value[at.xx] += xx, value[at.xy] += xy, value[at.yy] += yy;
    value[at.xz] += xz, value[at.yz] += yz, value[at.zz] += zz;
  };
  if (s.fa >= 0) add(s.fa);
  if (s.fb >= 0) add(s.fb);
  if (s.fa < 0 || s.fb < 0) return;
  double* cx = value + s.coupling[0];  // the block is symmetric: either orientation
  double* cy = value + s.coupling[1];
  double* cz = value + s.coupling[2];
  cx[0] -= xx, cx[1] -= xy, cx[2] -= xz;
  cy[0] -= xy, cy[1] -= yy, cy[2] -= yz;
  cz[0] -= xz, cz[1] -= yz, cz[2] -= zz;
}

// A held vertex moves within its plane (the filter S = I - n n^T of Baraff and Witkin 1998): its
// gradient loses what leads along n, and the step almost all of that, by a stiffness along n.
void SpringEnergy::hold_in_planes(const Contacts& contacts, bool matrix) {
  const Contacts::Timing measured = contacts.timing();
  double* value = matrix_.solver->values();
  for (int c = 0; c < contacts.count(); ++c) {
    if (!contacts.holds(c)) continue;
    const Eigen::Vector3d& n = contacts.normal(c);
    const int f = matrix_.place[contacts.vertex(c)];
    auto g = gradient_.segment<3>(3 * f);
    reaction_[c] = n.dot(g);
    g -= reaction_[c] * n;
    if (!matrix) continue;
    const Places& at = diagonal_[f];
    const double k = stiff_normal * (value[at.xx] + value[at.yy] + value[at.zz]);
    value[at.xx] += k * n[0] * n[0], value[at.xy] += k * n[0] * n[1];
    value[at.yy] += k * n[1] * n[1], value[at.xz] += k * n[0] * n[2];
    value[at.yz] += k * n[1] * n[2], value[at.zz] += k * n[2] * n[2];
  }
}

// Bending's share of both: quadratic, so that the matrix is its Hessian.
void SpringEnergy::assemble_bending(const Positions& x, bool matrix) {
  double* value = matrix_.solver->values();
  const double square = h_ * h_;
  for (std::size_t k = 0; k < hinges_.size(); ++k) {
    const BendingStencil& s = problem_.bending()[k];
    const Hinge& hinge = hinges_[k];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += s.coefficient[i] * x.col(s.vertex[i]);
    for (std::size_t i = 0, pair = 0; i < 4; ++i) {
      const int f = hinge.f[i];
      const double stiffness = square * s.stiffness * s.coefficient[i];
      if (f >= 0) gradient_.segment<3>(3 * f) += stiffness * sum;
      for (std::size_t j = 0; j < i; ++j, ++pair) {
        if (!matrix || f < 0 || hinge.f[j] < 0 || s.coefficient[i] * s.coefficient[j] == 0)
          continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          value[static_cast<std::size_t>(hinge.coupling[pair][axis]) + axis] +=
              stiffness * s.coefficient[j];
      }
      if (!matrix || f < 0) continue;
      const Places& at = diagonal_[f];
      const double own = stiffness * s.coefficient[i];
      value[at.xx] += own, value[at.yy] += own, value[at.zz] += own;
    }
  }
}

void SpringEnergy::predict_tension(const Positions& x, const Positions& to) {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Spring& s = springs_[k];
    const Eigen::Vector3d from = x.col(s.b) - x.col(s.a), ahead = to.col(s.b) - to.col(s.a);
    const double length = from.norm(), length_ahead = ahead.norm();
    const double elongation = (length > 0 ? from.dot(ahead) / length : length_ahead) - s.rest;
    pull_[k] = length_ahead > 0 ? s.k * elongation / length_ahead : 0;
  }
}

}  // namespace inextensible
