#include "harness/stability/case_expectations.h"

namespace harness::case_parts {

const Solvers everyone;

const std::set<Outcome> survives{Outcome::survived};
const std::set<Outcome> refuses{Outcome::refused};
const std::set<Outcome> either{Outcome::survived, Outcome::refused};
const std::set<Outcome> slow{Outcome::survived, Outcome::refused, Outcome::timeout};

}  // namespace harness::case_parts
