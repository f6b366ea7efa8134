// The two costs differ by orders of magnitude either way: on cloth that is little sheared, CG needs
// about ten iterations at any size, a few percent of a factorization; where warp and weft have
// become parallel it needs hundreds or thousands. Nothing but trying tells which, so this is the
// rent-or-buy problem (Karlin et al. 1988): CG iterations are rent. As long as no elimination order
// has been sought (the price is that of some `price` iterations), long solves are borne until what
// they have wasted adds up to that price. From then on a solve that is not done after `quick`
// iterations, about what a factorization costs, is finished by one; and CG is tried again after a
// number of factorizations that doubles each time it was in vain. All by counting, not by clocks,
// so that runs repeat exactly.
#include "solvers/linear/hybrid.h"

#include <algorithm>

namespace inextensible {
namespace {

constexpr int quick = 40, price = 1000;
constexpr int first_holiday = 8, longest_holiday = 512;

}  // namespace

HybridSpdSolver::HybridSpdSolver(SymmetricPattern pattern)
    : pattern_(pattern), cg_(std::move(pattern)), rhs_(pattern_.n), next_holiday_(first_holiday) {}

bool HybridSpdSolver::factor() {
  if (holiday_ > 0) {
    --holiday_;
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
    cg_.set_most_iterations(direct_ ? quick : price);
    if (cg_.solve_within(tolerance, rhs)) {
      next_holiday_ = first_holiday;
      wasted_ += std::max(0, static_cast<int>(cg_.iterations() - before) - quick);
      if (!direct_ && wasted_ > price) prepare_factorization();
      return true;
    }
    if (!direct_) prepare_factorization();
    holiday_ = next_holiday_;
    next_holiday_ = std::min(2 * next_holiday_, longest_holiday);
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
  direct_ = std::make_unique<FixedPatternCholesky>(std::move(ordered));
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
