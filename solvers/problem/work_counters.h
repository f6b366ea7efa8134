// Work done by a backend since it was made. For a given build these repeat exactly, so a comparison
// that must not be noisy uses them; counting is one addition per operation on a whole array.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

namespace inextensible {

struct WorkCounters {
  std::int64_t steps = 0;
  std::int64_t rejected_steps = 0;
  std::int64_t iterations = 0;
  std::int64_t assemblies = 0;
  std::int64_t factorizations = 0;
  std::int64_t back_solves = 0;
  std::int64_t linear_iterations = 0;
  std::int64_t edge_projections = 0;
  std::int64_t line_search_steps = 0;
  std::int64_t spring_evaluations = 0;
  std::int64_t triangle_tests = 0;
  std::int64_t contacts = 0;
  std::int64_t force_solves = 0;
  double factor_nonzeros = 0;
  double factor_flops = 0;

  bool operator==(const WorkCounters&) const = default;
};

// Factors what is in the solver, and counts that.
template <class Solver>
bool factor_counted(Solver& solver, WorkCounters& work) {
  ++work.factorizations;
  if (!solver.factor()) return false;
  work.factor_nonzeros = solver.factor_nonzeros();
  work.factor_flops = solver.factor_flops();
  return true;
}

// What files, gates, schemas and `bench list counters` know of a counter.
struct WorkCounterInfo {
  const char* name;
  std::variant<std::int64_t WorkCounters::*, double WorkCounters::*> member;
  const char* unit;
  const char* meaning;
};

inline constexpr auto work_counters = std::to_array<WorkCounterInfo>(
    {{"steps", &WorkCounters::steps, "steps", "accepted"},
     {"rejected_steps", &WorkCounters::rejected_steps, "steps", "refused, state untouched"},
     {"iterations", &WorkCounters::iterations, "iterations",
      "of Newton's method or a projection, or sweeps over all edges"},
     {"assemblies", &WorkCounters::assemblies, "matrices", "linear systems assembled"},
     {"factorizations", &WorkCounters::factorizations, "matrices", "numeric factorizations"},
     {"back_solves", &WorkCounters::back_solves, "right-hand sides",
      "forward and back substitutions, one right-hand side each"},
     {"linear_iterations", &WorkCounters::linear_iterations, "iterations",
      "of iterative linear solvers, in all back_solves"},
     {"edge_projections", &WorkCounters::edge_projections, "edges",
      "single edges corrected (strain limiting)"},
     {"line_search_steps", &WorkCounters::line_search_steps, "steps",
      "shortened by a globalization"},
     {"spring_evaluations", &WorkCounters::spring_evaluations, "springs",
      "shear springs and bending stencils evaluated, in forces or energies"},
     {"triangle_tests", &WorkCounters::triangle_tests, "triangles",
      "closest-point queries against single triangles"},
     {"contacts", &WorkCounters::contacts, "vertices", "moved by the collision filter"},
     {"force_solves", &WorkCounters::force_solves, "right-hand sides",
      "of the system of implicit shear, bending and drag, a coordinate each"},
     {"factor_nonzeros", &WorkCounters::factor_nonzeros, "entries",
      "of L (LU: of L + U), last factorization"},
     {"factor_flops", &WorkCounters::factor_flops, "operations",
      "of one factorization in floating point, where known"}});
static_assert(sizeof(WorkCounters) == work_counters.size() * sizeof(double),
              "a counter without a row, or a row without a counter");

}  // namespace inextensible
