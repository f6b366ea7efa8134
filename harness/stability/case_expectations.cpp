#include "harness/stability/case_expectations.h"

namespace harness::case_parts {

const std::set<std::string> current_direction{"fast_projection", "fast_projection_smoothed",
                                              "fast_projection_bdf2", "fast_projection_bdf2opt",
                                              "icd"};
const std::set<std::string> start_direction{"shake", "rattle"};
const std::set<std::string> strain_limiting{"jacobi", "gauss_seidel", "gauss_seidel_colored"};
const std::set<std::string> springs{"implicit_springs"};
const std::set<std::string> everyone{};

const std::set<Outcome> survives{Outcome::survived};
const std::set<Outcome> refuses{Outcome::refused};
const std::set<Outcome> either{Outcome::survived, Outcome::refused};
const std::set<Outcome> slow{Outcome::survived, Outcome::refused, Outcome::timeout};

}  // namespace harness::case_parts
