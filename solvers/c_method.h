// Methods from outside, behind the C interface (inextensible.h).
#pragma once

#include "solvers/inextensible.h"
#include "solvers/methods/backend.h"

namespace inextensible {

// The row of a method, which lives until the program ends. Throws std::invalid_argument, saying
// why, for one that is incomplete or whose settings make no sense. add_backends checks its name.
Backend row_of(const InextensibleMethod& method);

}  // namespace inextensible
