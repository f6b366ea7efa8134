// On cloth that is little sheared, CG takes a few percent of a factorization at any size; where
// warp and weft have become parallel, many times as long. Only trying tells which: the rent-or-buy
// problem (Karlin et al. 1988), with CG iterations as rent. Until an elimination order is computed
// (which costs about `ordering_cost` iterations), long solves go on until the iterations beyond
// `quick` add up to that cost. From then on a solve that has not converged after `quick`
// iterations, about the cost of a factorization, is finished by one, and CG is tried again after a
// retry interval, which doubles each time CG fails. Costs are counted, not timed, so that runs
// repeat exactly.
#include "solvers/linear/hybrid.h"

#include <algorithm>

namespace inextensible {
namespace {

constexpr int quick = 40, ordering_cost = 1000;      // iterations
constexpr int first_retry = 8, longest_retry = 512;  // factorizations

}  // namespace

HybridSpdSolver::HybridSpdSolver(SymmetricPattern pattern)
    : pattern_(pattern), cg_(std::move(pattern)), rhs_(pattern_.n), retry_interval_(first_retry) {}

bool HybridSpdSolver::factor() {
  if (until_retry_ > 0) {
    --until_retry_;
    return factor_wholly();
  }
  factored_ = false;
  cg_.set_least_pivot(least_pivot_);
  return cg_.factor();
}

bool HybridSpdSolver::solve_within(double tolerance, double* rhs) {
  if (!factored_) {
    std::copy_n(rhs, pattern_.n, rhs_.data());
    const auto before = cg_.iterations();
    cg_.set_most_iterations(direct_ ? quick : ordering_cost);
    if (cg_.solve_within(tolerance, rhs)) {
      retry_interval_ = first_retry;
      wasted_ += std::max(0, static_cast<int>(cg_.iterations() - before) - quick);
      if (!direct_ && wasted_ > ordering_cost) prepare_factorization();
      return true;
    }
    if (!direct_) prepare_factorization();
    until_retry_ = retry_interval_;
    retry_interval_ = std::min(2 * retry_interval_, longest_retry);
    std::copy_n(rhs_.data(), pattern_.n, rhs);
    if (!factor_wholly()) return false;
  }
  solve_factored(rhs);
  return true;
}

void HybridSpdSolver::prepare_factorization() {
  order_ = fill_reducing_order(pattern_);
  std::vector<int> row_of(order_.size());
  for (int i = 0; i < pattern_.n; ++i) row_of[order_[i]] = i;
  Pairs entries;
  for (int column = 0; column < pattern_.n; ++column) {
    for (int i = pattern_.column_start[column]; i < pattern_.column_start[column + 1]; ++i)
      entries.emplace_back(row_of[pattern_.row_index[i]], row_of[column]);
  }
  SymmetricPattern ordered = pattern_of(pattern_.n, entries, SymmetricPattern::Triangle::lower);
  for (const auto& [i, j] : entries) place_.push_back(ordered.place(i, j));
  direct_ = std::make_unique<MultifrontalCholesky<double>>(std::move(ordered));
}

bool HybridSpdSolver::factor_wholly() {
  double* to = direct_->values();
  const double* from = cg_.values();
  for (std::size_t i = 0; i < place_.size(); ++i) to[place_[i]] = from[i];
  direct_->set_least_pivot(least_pivot_);
  factored_ = true;
  return direct_->factor();
}

void HybridSpdSolver::solve_factored(double* rhs) {
  for (std::size_t i = 0; i < order_.size(); ++i) rhs_[i] = rhs[order_[i]];
  direct_->solve(rhs_.data());
  for (std::size_t i = 0; i < order_.size(); ++i) rhs[order_[i]] = rhs_[i];
}

}  // namespace inextensible
