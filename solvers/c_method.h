// Methods from outside, behind the C interface (inextensible.h).
#pragma once

#include "solvers/inextensible.h"
#include "solvers/methods/backend.h"

namespace inextensible {

// A problem as the interface's flat arrays, which belong to it and to this.
struct SceneArrays {
  SceneArrays(const Problem& problem, const BackendOptions& options, Along along);
  SceneArrays(const SceneArrays&) = delete;
  SceneArrays& operator=(const SceneArrays&) = delete;

  void add_body(const Problem& problem);

  InextensibleScene scene{};
  State start;  // a copy: an object that is made anew is made like the first one
  std::vector<double> mass, drag, coefficients, stiffness;
  std::vector<std::int32_t> stencils;
};

// The row of a method, which lives until the program ends. Throws std::invalid_argument, saying
// why, for one that is incomplete or whose settings make no sense. add_backends checks its name.
Backend row_of(const InextensibleMethod& method);

}  // namespace inextensible
