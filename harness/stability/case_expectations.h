// Whom an expectation of a hard case means, and what it allows.
#pragma once

#include <set>
#include <string>

#include "harness/stability/trial.h"

namespace harness::case_parts {

// Solvers, by where they take the constraint direction.
extern const std::set<std::string> current_direction;  // at the iterate
extern const std::set<std::string> start_direction;    // at the step's start
extern const std::set<std::string> strain_limiting;    // edge after edge
extern const std::set<std::string> springs;
extern const std::set<std::string> everyone;

extern const std::set<Outcome> survives, refuses;
extern const std::set<Outcome> either;  // survives or refuses
extern const std::set<Outcome> slow;    // either, or takes too long

}  // namespace harness::case_parts
