#include "harness/base/bounds.h"

#include <cmath>

#include "harness/base/text.h"

namespace harness {

std::string Bounds::text() const {
  std::string words = whole ? "a whole number" : "a number";
  const int digits = whole ? 16 : 6;
  if (least > -huge) words += (above ? " above " : " of at least ") + number_text(least, digits);
  if (most < huge)
    words += (least > -huge ? " and" : "") +
             ((below ? " below " : " at most ") + number_text(most, digits));
  return words;
}

bool Bounds::hold(double number) const {
  return std::isfinite(number) && (above ? number > least : number >= least) &&
         (below ? number < most : number <= most) && (!whole || number == std::floor(number));
}

}  // namespace harness
