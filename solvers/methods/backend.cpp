#include "inextensible/methods/backend.h"

#include <cmath>

namespace inextensible {

bool Range::contains(double number) const {
  if (!std::isfinite(number)) return false;
  return open ? number > least && number < largest : number >= least && number <= largest;
}

}  // namespace inextensible
