#include "solvers/problem/step_result.h"

namespace inextensible {

const char* to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::not_converged:
      return "not_converged";
    case Status::singular:
      return "singular";
    case Status::not_finite:
      return "not_finite";
  }
  return "?";
}

}  // namespace inextensible
