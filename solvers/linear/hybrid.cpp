// The two costs differ by orders of magnitude either way: on cloth that is little sheared, CG needs
// about ten iterations at any size, a few percent of a factorization; where warp and weft have
// become parallel it needs hundreds or thousands. Only trying tells which, so this is the
// rent-or-buy problem (Karlin et al. 1988): CG iterations are rent. As long as no elimination order
// has been computed (which costs about `ordering_cost` iterations), long solves go on until the
// iterations beyond `quick` add up to that cost. From then on a solve that has not converged after
// `quick` iterations, about the cost of a factorization, is finished by one. CG is tried again
// after a retry interval, which doubles each time CG fails. Costs are counted, not timed, so that
// runs repeat exactly.
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
  // Lower triangle, column by column, rows ascending: a bucket sort by column of a bucket sort by
  // row.
  struct Entry {
    int row, column, from;
  };
  std::vector<Entry> entries(pattern_.entries()), by_row(entries.size());
  for (int column = 0; column < pattern_.n; ++column) {
    for (int i = pattern_.column_start[column]; i < pattern_.column_start[column + 1]; ++i) {
      const int p = row_of[column], q = row_of[pattern_.row_index[i]];
      entries[i] = {std::max(p, q), std::min(p, q), i};
    }
  }
  const auto sort_by = [n = pattern_.n](int Entry::*key, const std::vector<Entry>& from,
                                        std::vector<Entry>& to) {
    std::vector<int> start(n + 1);
    for (const Entry& entry : from) ++start[entry.*key + 1];
    for (int i = 0; i < n; ++i) start[i + 1] += start[i];
    std::vector<int> end = start;
    for (const Entry& entry : from) to[end[entry.*key]++] = entry;
    return start;
  };
  sort_by(&Entry::row, entries, by_row);
  SymmetricPattern ordered;
  ordered.n = pattern_.n;
  ordered.triangle = SymmetricPattern::Triangle::lower;
  ordered.column_start = sort_by(&Entry::column, by_row, entries);
  place_.resize(entries.size());
  ordered.row_index.resize(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ordered.row_index[i] = entries[i].row;
    place_[entries[i].from] = static_cast<int>(i);
  }
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
