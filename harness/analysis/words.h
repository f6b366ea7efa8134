// Numbers as tables and pages say them.
#pragma once

#include <array>
#include <string>

#include "harness/base/statistics.h"

namespace harness::analysis {

// As people call it: of a mesh its file's name, "shirt.obj" of "mesh:clothes/shirt.obj,pins=y>1.2".
std::string scene_words(const std::string& scene);
std::string percent(double fraction);    // "1.2 %"
std::string time_words(double seconds);  // "1.23 s", "41.3 ms", "0.51 ms"
// "3.5 (3.3-3.8)" with its 95 % interval; "3.5 (?)": it is not known.
std::string text(const Ratio& ratio);

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
