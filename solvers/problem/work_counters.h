// Work done by a backend since it was made. For a given build these repeat exactly, so a comparison
// that must not be noisy uses them; counting is one addition per operation on a whole array.
#pragma once

#include <cstdint>

namespace inextensible {

struct WorkCounters {
  std::int64_t steps = 0;               // accepted
  std::int64_t rejected_steps = 0;      // refused, state untouched
  std::int64_t iterations = 0;          // Newton or projection iterations, or sweeps over all edges
  std::int64_t assemblies = 0;          // of the linear system
  std::int64_t factorizations = 0;      // numeric
  std::int64_t back_solves = 0;         // one right-hand side, forward and back substitution
  std::int64_t linear_iterations = 0;   // of iterative linear solvers, of all back_solves
  std::int64_t edge_projections = 0;    // single edges corrected (strain limiting)
  std::int64_t line_search_steps = 0;   // steps shortened by a globalization
  std::int64_t spring_evaluations = 0;  // shear springs, in forces or energies
  std::int64_t triangle_tests = 0;      // closest-point queries against single triangles
  std::int64_t contacts = 0;            // vertices moved by the collision filter
  double factor_nonzeros = 0;           // of L (LU: of L + U), last factorization
  double factor_flops = 0;              // of one factorization, where known

  bool operator==(const WorkCounters&) const = default;
};

}  // namespace inextensible
