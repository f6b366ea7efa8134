// Whom an expectation of a hard case means, and what it allows.
#pragma once

#include <set>

#include "harness/stability/hard_case.h"

namespace harness::case_parts {

// Solvers, by where they take the constraint direction.
constexpr auto current_direction = inextensible::Direction::current;
constexpr auto start_direction = inextensible::Direction::start;
constexpr auto strain_limiting = inextensible::Direction::local;
constexpr auto springs = inextensible::Direction::springs;
extern const Solvers everyone;

extern const std::set<Outcome> survives, refuses;
extern const std::set<Outcome> either;  // survives or refuses
extern const std::set<Outcome> slow;    // either, or takes too long

}  // namespace harness::case_parts
