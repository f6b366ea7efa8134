// Forces other than inextensibility, and the unconstrained step.
#pragma once

#include "solvers/problem/problem.h"
#include "solvers/problem/work_counters.h"

namespace inextensible {

// x0 = x + h v + h^2 (g - W grad V(x) - W D v), V of shear and bending, D of drag; pinned vertices
// stay. Symplectic Euler, V explicit.
void unconstrained_step(const Problem& problem, const State& state, double h, Positions& x0,
                        WorkCounters& work);

// y = x + h v + scale g of the state, in pinned vertices x.
void free_flight(const Problem& problem, const State& state, double h, double scale, Positions& y);

// y += scale (g - W grad V(x)), the acceleration by everything but inextensibility and drag. Pinned
// vertices get gravity too; the caller puts them back.
void add_acceleration(const Problem& problem, const Positions& x, double scale, Positions& y,
                      WorkCounters& work);

// y -= scale W D v, drag's. v: 3 x n, m/s; may be y.
void add_drag(const Problem& problem, const Positions& v, double scale, Positions& y);

// f += M g - grad V(x) - D v, N, on free vertices, with shear at shear_at instead of x.
void add_forces(const Problem& problem, const Positions& x, const Positions& shear_at,
                const Positions& v, Positions& f, WorkCounters& work);

// Potential energy of gravity (zero at the origin), shear and bending, J.
double potential_energy(const Problem& problem, const Positions& x);
double kinetic_energy(const Problem& problem, const Positions& v);

}  // namespace inextensible
