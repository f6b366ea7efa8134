#include "solvers/systems/kkt_system.h"

#include <Eigen/SparseCholesky>

#include "solvers/linear/spd_solver.h"

namespace inextensible {
namespace {

constexpr double regularization = 1e-10;  // relative to J W J^T, of order one after scaling
constexpr int refinement_limit = 8;

// L D L^T of a sparse quasi-definite matrix in its own order, by Eigen's up-looking code. Such a
// matrix has negative pivots, and is factored without pivoting in any order (Vanderbei 1995).
class QuasiDefiniteSolver : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper,
                                                  Eigen::NaturalOrdering<int>> {
 public:
  explicit QuasiDefiniteSolver(const SymmetricPattern& upper_triangle) {
    const std::vector<double> zeros(upper_triangle.entries(), 0.0);
    matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(
        upper_triangle.n, upper_triangle.n, upper_triangle.entries(),
        upper_triangle.column_start.data(), upper_triangle.row_index.data(), zeros.data());
    analyzePattern(matrix_);
  }
  double* values() { return matrix_.valuePtr(); }  // in the pattern's order
  // false: a pivot is zero or not finite.
  bool factor() {
    factorize(matrix_);
    return info() == Eigen::Success && m_diag.allFinite();
  }
  // Overwrites the right-hand side by the solution.
  void solve(double* rhs) const {
    Eigen::Map<Eigen::VectorXd> x(rhs, m_diag.size());  // vectorD() would return a copy
    matrixL().solveInPlace(x);
    x.array() /= m_diag.array();
    matrixU().solveInPlace(x);
  }
  // From the last factorization: the matrix's negative eigenvalues (Sylvester's law of inertia).
  int negative_pivots() const { return static_cast<int>((m_diag.array() < 0).count()); }
  double factor_nonzeros() const { return (m_nonZerosPerCol.array().cast<double>() + 1).sum(); }
  double factor_flops() const {
    return (m_nonZerosPerCol.array().cast<double>() + 1).square().sum();
  }

 private:
  Eigen::SparseMatrix<double> matrix_;
};

class KktSystem final : public KktSolver {
 public:
  KktSystem(const Problem& problem, const EdgeConstraints& edges, FactoredBy by)
      : KktSolver(problem, edges), umfpack_only_(by == FactoredBy::umfpack) {
    vertex_unknown_.assign(problem.vertices(), -1);
    for (int v = 0; v < problem.vertices(); ++v) {
      if (problem.inverse_mass()[v] == 0) continue;
      vertex_unknown_[v] = 3 * static_cast<int>(free_vertex_.size());
      free_vertex_.push_back(v);
    }
    multiplier_offset_ = 3 * static_cast<int>(free_vertex_.size());
    size_ = multiplier_offset_ + edges.count();

    build_pattern();
    for (Eigen::VectorXd* v : {&rhs_, &solution_, &residual_}) v->resize(size_);
    if (!umfpack_only_) ldlt_ = std::make_unique<QuasiDefiniteSolver>(pattern_);
  }

 private:
  struct EdgePlaces {  // of entries, by axis
    int coupling[3], at_a[3], at_b[3];
  };

  int unknown(int vertex, int axis) const {  // -1 if pinned
    const int first = vertex_unknown_[vertex];
    return first < 0 ? -1 : first + axis;
  }

  void build_pattern() {
    Pairs pairs;  // of unknowns
    const auto couple = [&](int i, int j) {
      if (i >= 0 && j >= 0) pairs.emplace_back(i, j);
    };
    for (int k = 0; k < edges_.count(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const int a = unknown(edges_.a[k], axis), b = unknown(edges_.b[k], axis);
        couple(a, multiplier_offset_ + k);
        couple(b, multiplier_offset_ + k);
        couple(a, b);
      }
    const auto upper = SymmetricPattern::Triangle::upper;
    const std::vector<int> order = fill_reducing_order(pattern_of(size_, pairs, upper));
    place_.resize(size_);
    for (int i = 0; i < size_; ++i) place_[order[i]] = i;
    for (auto& [i, j] : pairs) i = place_[i], j = place_[j];
    pattern_ = pattern_of(size_, pairs, upper);
    matrix_.resize(pattern_.entries());

    const auto entry = [&](int i, int j) {
      return i >= 0 && j >= 0 ? pattern_.place(place_[i], place_[j]) : -1;
    };
    for (int i = 0; i < size_; ++i) diagonal_.push_back(entry(i, i));
    edge_places_.resize(edges_.count());
    for (int k = 0; k < edges_.count(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const int a = unknown(edges_.a[k], axis), b = unknown(edges_.b[k], axis);
        edge_places_[k].at_a[axis] = entry(a, multiplier_offset_ + k);
        edge_places_[k].at_b[axis] = entry(b, multiplier_offset_ + k);
        edge_places_[k].coupling[axis] = entry(a, b);
      }
  }

  void assemble() {
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    for (int i = 0; i < multiplier_offset_; ++i)
      matrix_[diagonal_[i]] = problem_.mass()[free_vertex_[i / 3]] / mean_mass_;
    for (std::size_t k = 0; k < edge_places_.size(); ++k) {
      const EdgePlaces& places = edge_places_[k];
      const double curved = curvature(static_cast<Eigen::Index>(k));
      const int a = vertex_unknown_[edges_.a[k]];
      const int b = vertex_unknown_[edges_.b[k]];
      for (int axis = 0; axis < 3; ++axis) {
        const double gradient = (*u_)(axis, static_cast<Eigen::Index>(k));
        if (a >= 0) {
          matrix_[diagonal_[a + axis]] += curved;
          matrix_[places.at_a[axis]] -= gradient;
        }
        if (b >= 0) {
          matrix_[diagonal_[b + axis]] += curved;
          matrix_[places.at_b[axis]] += gradient;
        }
        if (a >= 0 && b >= 0) matrix_[places.coupling[axis]] -= curved;
      }
    }
  }

  bool factor_itself(WorkCounters& work) override {
    for (;; convex_ = true) {
      convexified_ = convex_;
      assemble();
      ++work.assemblies;
      using_umfpack_ = umfpack_only_;
      if (umfpack_only_) return factor_umfpack(work);
      std::copy(matrix_.begin(), matrix_.end(), ldlt_->values());
      for (int i = multiplier_offset_; i < size_; ++i)
        ldlt_->values()[diagonal_[i]] = -regularization;
      if (!factor_counted(*ldlt_, work)) return factor_umfpack(work);
      if (convex_ || ldlt_->negative_pivots() == edges_.count()) return true;
    }
  }

  bool factor_umfpack(WorkCounters& work) {
    if (!lu_) {  // with both triangles; made when first needed
      Pairs pairs;
      for (int j = 0; j < size_; ++j)
        for (int e = pattern_.column_start[j]; e < pattern_.column_start[j + 1]; ++e)
          pairs.emplace_back(pattern_.row_index[e], j);
      SymmetricPattern both = pattern_of(size_, pairs, SymmetricPattern::Triangle::both);
      for (int j = 0; j < size_; ++j)
        for (int e = both.column_start[j]; e < both.column_start[j + 1]; ++e)
          full_from_upper_.push_back(pattern_.place(both.row_index[e], j));
      lu_ = make_lu_solver(std::move(both));
    }
    using_umfpack_ = true;
    for (std::size_t i = 0; i < full_from_upper_.size(); ++i)
      lu_->values()[i] = matrix_[full_from_upper_[i]];
    return factor_counted(*lu_, work);
  }

  void residual() {  // residual_ = rhs_ - K solution_
    residual_ = rhs_;
    for (int j = 0; j < size_; ++j) {
      double sum = 0;
      const double xj = solution_[j];
      for (int i = pattern_.column_start[j]; i < pattern_.column_start[j + 1]; ++i) {
        const int row = pattern_.row_index[i];
        const double value = matrix_[i];
        sum += value * solution_[row];
        if (row != j) residual_[row] -= value * xj;
      }
      residual_[j] -= sum;
    }
  }

  bool solve_itself(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
                    WorkCounters& work) override {
    for (int i = 0; i < multiplier_offset_; ++i) rhs_[place_[i]] = r(i % 3, free_vertex_[i / 3]);
    for (Eigen::Index k = 0; k < c.size(); ++k) rhs_[place_[multiplier_offset_ + k]] = c[k];

    const double scale = rhs_.norm();
    for (;;) {
      solution_.setZero();
      residual_ = rhs_;
      double error = scale;
      for (int i = 0; i < refinement_limit && error > refinement_goal * scale; ++i) {
        using_umfpack_ ? lu_->solve(residual_.data()) : ldlt_->solve(residual_.data());
        ++work.back_solves;
        solution_ += residual_;
        residual();
        const double last = error;
        error = residual_.norm();
        if (!(error < 0.5 * last) && i > 0) break;
      }
      if (error <= acceptable_residual * scale) break;  // false on NaN
      if (using_umfpack_ || !factor_umfpack(work)) return false;
    }

    p.setZero();
    for (int i = 0; i < multiplier_offset_; ++i)
      p(i % 3, free_vertex_[i / 3]) = solution_[place_[i]];
    for (Eigen::Index k = 0; k < c.size(); ++k) q[k] = solution_[place_[multiplier_offset_ + k]];
    return true;
  }

  bool umfpack_only_;
  bool using_umfpack_ = false;
  std::vector<int> vertex_unknown_;  // first of a vertex's three unknowns, -1 if pinned
  std::vector<int> free_vertex_;
  int size_ = 0, multiplier_offset_ = 0;
  std::vector<int> place_;  // unknown -> row in elimination order
  SymmetricPattern pattern_;
  std::vector<double> matrix_;  // upper triangle of K, without the regularization
  std::vector<int> diagonal_;   // the place of each unknown's diagonal entry
  std::vector<EdgePlaces> edge_places_;
  std::unique_ptr<QuasiDefiniteSolver> ldlt_;
  std::unique_ptr<DirectSolver> lu_;
  std::vector<int> full_from_upper_;
  Eigen::VectorXd rhs_, solution_, residual_;
};

}  // namespace

std::unique_ptr<KktSolver> make_kkt_system(const Problem& problem, const EdgeConstraints& edges,
                                           FactoredBy by) {
  return std::make_unique<KktSystem>(problem, edges, by);
}

KktSolver::KktSolver(const Problem& problem, const EdgeConstraints& edges)
    : problem_(problem),
      edges_(edges),
      mean_mass_(problem.total_mass() / static_cast<double>(problem.vertices())) {}

bool KktSolver::factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu,
                       const Contacts* contacts, bool convex, WorkCounters& work) {
  u_ = &u;
  mu_ = &mu;
  contacts_ = contacts;
  convex_ = convex;
  left_to_other_ = false;
  return factor_itself(work) || leave_to_other(work);
}

bool KktSolver::solve(const Positions& r, const Eigen::VectorXd& c, Positions& p,
                      Eigen::VectorXd& q, WorkCounters& work) {
  if (!left_to_other_ && solve_itself(r, c, p, q, work)) return true;
  return (left_to_other_ || leave_to_other(work)) && other_->solve(r, c, p, q, work);
}

bool KktSolver::leave_to_other(WorkCounters& work) {
  if (!other_) other_ = make_other();
  if (!other_) return false;
  left_to_other_ = true;
  const bool factored = other_->factor(*u_, *mu_, nullptr, convex_, work);
  convexified_ = other_->convexified();
  return factored;
}

}  // namespace inextensible
