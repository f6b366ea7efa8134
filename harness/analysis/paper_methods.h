// The paper's methods, by the names that they have here: the one place of analysis and claims that
// knows solvers by name.
#pragma once

#include <array>

namespace harness::analysis {

struct PaperMethod {
  const char* name;  // of the contestant in result files, and of the solver
  const char* words;
};

inline constexpr PaperMethod implicit_springs{"implicit_springs", "implicit springs"},
    jacobi{"jacobi", "Jacobi"}, gauss_seidel{"gauss_seidel", "Gauss-Seidel"},
    shake{"shake", "SHAKE"}, icd{"icd", "ICD"},
    fast_projection{"fast_projection", "fast projection"};
inline constexpr std::array all_paper_methods{implicit_springs, jacobi, gauss_seidel, shake, icd,
                                              fast_projection};

}  // namespace harness::analysis
