// What every use of CHOLMOD on a SymmetricPattern needs.
#pragma once

#include <cholmod.h>

#include <new>

#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {

// The pattern with these values, if any, as CHOLMOD's matrix; both must outlive it.
inline cholmod_sparse cholmod_view(const SymmetricPattern& pattern, double* values) {
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = pattern.n;
  matrix.nzmax = pattern.entries();
  matrix.p = const_cast<int*>(pattern.column_start.data());
  matrix.i = const_cast<int*>(pattern.row_index.data());
  matrix.x = values;
  matrix.stype = pattern.triangle == SymmetricPattern::Triangle::upper ? 1 : -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  return matrix;
}

// CHOLMOD's settings and a factor, without messages; to begin with for matrices that are in
// elimination order already (fill_reducing_order).
struct CholmodAnalysis {
  mutable cholmod_common common{};  // of every call, those that only look as well
  cholmod_factor* l = nullptr;

  CholmodAnalysis() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
  }
  ~CholmodAnalysis() {
    cholmod_free_factor(&l, &common);
    cholmod_finish(&common);
  }
  CholmodAnalysis(const CholmodAnalysis&) = delete;
  CholmodAnalysis& operator=(const CholmodAnalysis&) = delete;

  void analyze(const SymmetricPattern& pattern) {
    cholmod_sparse matrix = cholmod_view(pattern, nullptr);
    l = cholmod_analyze(&matrix, &common);
    if (!l) throw std::bad_alloc();
  }
};

}  // namespace inextensible
