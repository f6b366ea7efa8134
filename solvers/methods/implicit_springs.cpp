// A backward Euler step minimizes  E(x) = 1/2 |x - (x^n + h v^n + h^2 g)|_M^2 + h^2 V(x),  V =
// stretch and shear springs. Newton with each spring's Hessian projected to be positive
// semidefinite (a compressed spring's negative stiffness across its direction is dropped; Choi and
// Ko 2002, Teran et al. 2005) always descends; backtracking on E. Loops: one assembly,
// factorization and solve, and one or more energy evaluations, an iteration.
//
// Three things make it cheap without changing E, its gradient, the descent test or the criterion to
// stop. (1) Newton starts at the lowest of the free flight, the start of the step, and its
// extrapolation to second order. (2) Stiff springs are almost constraints: their tension at an
// iterate is far off, that of the last linearization is not, and is the Hessian's stiffness across
// the spring (as primal-dual methods keep a multiplier). (3) Near the end a factorization is kept
// for further iterations while these shrink.
#include "solvers/methods/implicit_springs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/methods/rows.h"

namespace inextensible {
namespace {

// A held vertex's stiffness along the normal, over the rest of its diagonal block.
constexpr double stiff_normal = 1e6;

std::vector<SpringHessian::Spring> springs_of(const Problem& problem, double stiffness) {
  std::vector<SpringHessian::Spring> springs;
  const auto add = [&](Edge e, double rest, double k) {
    springs.push_back({e.a, e.b, -1, -1, rest, k, {}});
  };
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    add(problem.edges()[k], problem.rest_length()[k], stiffness / problem.rest_length()[k]);
  }
  if (const Springs* shear = problem.shear()) {
    for (std::size_t k = 0; k < shear->edges.size(); ++k)
      add(shear->edges[k], shear->rest_length[k], shear->stiffness[k]);
  }
  return springs;
}

Pairs coupled_vertices(const Problem& problem, const std::vector<SpringHessian::Spring>& springs) {
  Pairs pairs;
  for (const auto& s : springs) pairs.emplace_back(s.a, s.b);
  for (const BendingStencil& s : problem.bending()) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(s.vertex[i], s.vertex[j]);
    }
  }
  return pairs;
}

// Where each column of the block that couples i and j begins among a matrix's values.
std::array<int, 3> block_begin(const SymmetricPattern& pattern, int i, int j) {
  if (pattern.triangle ==
      (i < j ? SymmetricPattern::Triangle::lower : SymmetricPattern::Triangle::upper))
    std::swap(i, j);
  const auto at = [&](int c) { return pattern.place(3 * i, 3 * j + c); };
  return {at(0), at(1), at(2)};
}

}  // namespace

SpringHessian::SpringHessian(const Problem& problem, double stiffness)
    : springs(springs_of(problem, stiffness)),
      matrix(problem, coupled_vertices(problem, springs), "auto", 3) {
  const SymmetricPattern& pattern = matrix.pattern;
  for (int f = 0; f < static_cast<int>(matrix.vertex.size()); ++f) {
    const auto at = [&](int i, int j) { return pattern.place(3 * f + i, 3 * f + j); };
    diagonal.push_back({at(0, 0), at(0, 1), at(1, 1), at(0, 2), at(1, 2), at(2, 2)});
  }
  for (Spring& s : springs) {
    s.fa = matrix.place[s.a];
    s.fb = matrix.place[s.b];
    if (s.fa < 0 || s.fb < 0) continue;
    s.coupling = block_begin(pattern, s.fa, s.fb);
  }
  for (const BendingStencil& s : problem.bending()) {
    Hinge hinge{};
    for (std::size_t i = 0, pair = 0; i < 4; ++i) {
      hinge.f[i] = matrix.place[s.vertex[i]];
      for (std::size_t j = 0; j < i; ++j, ++pair) {
        if (hinge.f[i] >= 0 && hinge.f[j] >= 0)
          hinge.coupling[pair] = block_begin(pattern, hinge.f[i], hinge.f[j]);
      }
    }
    hinges.push_back(hinge);
  }
}

ImplicitSprings::ImplicitSprings(std::shared_ptr<const Problem> shared,
                                 const BackendOptions& options)
    : Stepper(std::move(shared)),
      hessian_(problem(), options.number("stiffness")),
      max_iterations_(options.count("max_iterations")),
      step_tolerance_(options.number("newton_tolerance") * options.strain_limit *
                      problem().shortest_rest_length()),
      reuse_below_(options.number("reuse") * step_tolerance_) {
  const Problem& p = problem();
  if (step_tolerance_ == 0) step_tolerance_ = 1e-12;  // no edge says what is small: rounding
  for (Positions* x : {&inertial_, &trial_, &ahead_, &v_before_}) x->resize(3, p.vertices());
  if (p.has_drag()) before_.resize(3, p.vertices());
  if (p.contact_inside()) {
    reaction_.resize(p.vertices());
    released_.resize(p.vertices());
  }
  const auto unknowns = static_cast<Eigen::Index>(3 * hessian_.matrix.vertex.size());
  gradient_.resize(unknowns);
  step_.resize(unknowns);
  pull_.resize(hessian_.springs.size());
  pull_before_.assign(hessian_.springs.size(), 0.0);
}

double ImplicitSprings::energy(const Positions& x, double h) const {
  double inertia = 0, potential = 0;
  for (const int v : hessian_.matrix.vertex)
    inertia += problem().mass()[v] * (x.col(v) - inertial_.col(v)).squaredNorm();
  if (problem().has_drag()) {  // backward Euler's drag is the gradient of h / 2 |x - x^n|_D^2
    for (const int v : hessian_.matrix.vertex)
      inertia += h * problem().drag(v) * (x.col(v) - before_.col(v)).squaredNorm();
  }
  potential += 2 * bending_energy(problem().bending(), x);
  const double* p = x.data();
  for (const Spring& s : hessian_.springs) {
    const double* pa = p + 3 * s.a;
    const double* pb = p + 3 * s.b;
    const double d0 = pb[0] - pa[0], d1 = pb[1] - pa[1], d2 = pb[2] - pa[2];
    const double elongation = std::sqrt(d0 * d0 + d1 * d1 + d2 * d2) - s.rest;
    potential += s.k * elongation * elongation;
  }
  return 0.5 * (inertia + h * h * potential);
}

// gradient_ and, if wanted, the solver's matrix: M + h^2 sum of projected spring Hessians, at x.
void ImplicitSprings::assemble(const Positions& x, double h, bool matrix) {
  double* value = hessian_.matrix.solver->values();
  if (matrix) std::fill(value, value + hessian_.matrix.pattern.entries(), 0.0);
  const double* p = x.data();
  double* g = gradient_.data();
  for (std::size_t f = 0; f < hessian_.matrix.vertex.size(); ++f) {
    const int v = hessian_.matrix.vertex[f];
    const double mass = problem().mass()[v];
    const double drag = problem().has_drag() ? h * problem().drag(v) : 0;
    for (int i = 0; i < 3; ++i) {
      g[3 * f + i] = mass * (x(i, v) - inertial_(i, v));
      if (problem().has_drag()) g[3 * f + i] += drag * (x(i, v) - before_(i, v));
    }
    const Places& at = hessian_.diagonal[f];
    if (matrix) value[at.xx] = value[at.yy] = value[at.zz] = mass + drag;
  }
  assemble_bending(x, h, matrix);
  for (std::size_t k = 0; k < hessian_.springs.size(); ++k) {
    const Spring& s = hessian_.springs[k];
    const double* pa = p + 3 * s.a;
    const double* pb = p + 3 * s.b;
    const double dx = pb[0] - pa[0], dy = pb[1] - pa[1], dz = pb[2] - pa[2];
    const double squared = dx * dx + dy * dy + dz * dz;
    const double inverse_length = squared > 0 ? 1 / std::sqrt(squared) : 0;
    const double stiffness = h * h * s.k;
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
    const double transverse = std::clamp(h * h * pull_[k], 0.0, stiffness);
    add_block(s, {dx, dy, dz}, (stiffness - transverse) * (inverse_length * inverse_length),
              transverse);
  }
  if (contacts_inside()) hold_in_planes(matrix);
}

// along d d^T + transverse I: both diagonal blocks, and the coupling with the opposite sign.
inline void ImplicitSprings::add_block(const Spring& s, const std::array<double, 3>& d,
                                       double along, double transverse) {
  double* value = hessian_.matrix.solver->values();
  const auto [dx, dy, dz] = d;
  const double xx = along * dx * dx + transverse, xy = along * dx * dy, xz = along * dx * dz,
               yy = along * dy * dy + transverse, yz = along * dy * dz,
               zz = along * dz * dz + transverse;
  const auto add = [&](int f) {
    const Places& at = hessian_.diagonal[f];
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
// gradient loses what leads along n, and so does the step, by a stiffness along n that leaves next
// to nothing of it.
void ImplicitSprings::hold_in_planes(bool matrix) {
  const Contacts::Timing measured = contacts_->timing();
  double* value = hessian_.matrix.solver->values();
  for (int c = 0; c < contacts_->count(); ++c) {
    if (!contacts_->holds(c)) continue;
    const Eigen::Vector3d n = contacts_->normal(c);
    const int f = hessian_.matrix.place[contacts_->vertex(c)];
    auto g = gradient_.segment<3>(3 * f);
    reaction_[c] = n.dot(g);
    g -= reaction_[c] * n;
    if (!matrix) continue;
    const Places& at = hessian_.diagonal[f];
    const double k = stiff_normal * (value[at.xx] + value[at.yy] + value[at.zz]);
    value[at.xx] += k * n[0] * n[0], value[at.xy] += k * n[0] * n[1];
    value[at.yy] += k * n[1] * n[1], value[at.xz] += k * n[0] * n[2];
    value[at.yz] += k * n[1] * n[2], value[at.zz] += k * n[2] * n[2];
  }
}

// Bending's share of both: quadratic, so that the matrix is its Hessian.
void ImplicitSprings::assemble_bending(const Positions& x, double h, bool matrix) {
  double* value = hessian_.matrix.solver->values();
  for (std::size_t k = 0; k < hessian_.hinges.size(); ++k) {
    const BendingStencil& s = problem().bending()[k];
    const Hinge& hinge = hessian_.hinges[k];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += s.coefficient[i] * x.col(s.vertex[i]);
    for (std::size_t i = 0, pair = 0; i < 4; ++i) {
      const int f = hinge.f[i];
      const double stiffness = h * h * s.stiffness * s.coefficient[i];
      if (f >= 0) gradient_.segment<3>(3 * f) += stiffness * sum;
      for (std::size_t j = 0; j < i; ++j, ++pair) {
        if (!matrix || f < 0 || hinge.f[j] < 0 || s.coefficient[i] * s.coefficient[j] == 0)
          continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          value[static_cast<std::size_t>(hinge.coupling[pair][axis]) + axis] +=
              stiffness * s.coefficient[j];
      }
      if (!matrix || f < 0) continue;
      const Places& at = hessian_.diagonal[f];
      const double own = stiffness * s.coefficient[i];
      value[at.xx] += own, value[at.yy] += own, value[at.zz] += own;
    }
  }
}

Backend implicit_springs_row() {
  return {
      .name = "implicit_springs",
      .summary = "stiff springs, by Newton with line search",
      .strain_control = StrainControl::stiffness,
      .settings =
          {{"stiffness", 1e4, "spring stiffness EA in N; sweeps search it", positive},
           iteration_limit(300, "Newton iterations a step before it is refused"),
           {"newton_tolerance", 0.1, "last Newton step, in strain limit times shortest rest length",
            positive, SearchRange{0.01, 10}},
           // Instructions at 1 % strain and 1/100 s, plain Newton = 1, on the chain of 80 and the
           // drape of 21 x 21: 0.66 and 0.77 without reuse, 0.59 and 0.55 with 10. A reuse of 30
           // takes 0.55 and 0.53 but ends steps less exactly on the chain.
           {"reuse", 10.0,
            "a Newton step below this many tolerances keeps its factorization for the next; 0: "
            "never",
            Range{}, SearchRange{0, 100}}},
      .make = make_step<ImplicitSprings>,
      .direction = Direction::springs,
      .citation = "Baraff and Witkin 1998",
      .origin = Origin::paper,
      .label = "implicit springs",
      .backward_euler = true};
}

}  // namespace inextensible
