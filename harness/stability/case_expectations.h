// Whom an expectation of a hard case means, and which outcome it expects.
#pragma once

#include "harness/stability/hard_case.h"

namespace harness::case_parts {

// Solvers, by where they take the constraint direction.
constexpr auto current_direction = inextensible::Direction::current;
constexpr auto end_direction = inextensible::Direction::end;
constexpr auto start_direction = inextensible::Direction::start;
constexpr auto strain_limiting = inextensible::Direction::local;
constexpr auto springs = inextensible::Direction::springs;
inline const Solvers everyone;
// Methods of multipliers: the direction of the end, but each edge's multiplier grows by itself, by
// `multiplier_penalty` times its elongation over its ends' inertia in a pass. No matrix of J is
// solved.
inline const Solvers multipliers{"augmented_vbd", "projective_dynamics"};
constexpr double multiplier_penalty = 10;

constexpr Outcome survives = Outcome::survived;
constexpr Outcome refuses = Outcome::refused;

}  // namespace harness::case_parts
