// How the constrained system accelerates at a state, for what needs it outside the time steps.
#pragma once

#include "solvers/problem/problem.h"

namespace inextensible {

// a = W (f - J^T lambda) with f gravity and shear, and lambda such that C'' = J a + J' v = 0:
//   J W J^T lambda = J W f + J' v,
// in m/s^2; 0 for pinned vertices. Where J W J^T is singular, a keeps as much of C'' = 0 as there
// is a force for. Collisions are left out. The state fits the problem and is finite. Not for time
// steps: it builds and factors J W J^T each time, and allocates.
Positions constrained_acceleration(const Problem& problem, const State& state);

// The state with its velocities half a step earlier, v - h/2 a: where methods start whose velocity
// v^n = (x^n - x^{n-1}) / h is that of the middle of the step before (Velocities::half_step in
// methods/backend.h). From velocities of the start itself they are first order only, in free fall
// by g t h / 2. h in s.
State start_half_step_back(const Problem& problem, const State& state, double h);

}  // namespace inextensible
