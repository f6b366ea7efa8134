#include "solvers/methods/setting_fields.h"

#include "solvers/linear/spd_solvers.h"

namespace inextensible {

std::vector<const char*> schur_solvers() {
  std::vector<const char*> names{"auto"};
  for (const SpdSolverRow& row : spd_solvers()) {
    if (row.takes != Takes::block_tridiagonal) names.push_back(row.name);
  }
  return names;
}

}  // namespace inextensible
