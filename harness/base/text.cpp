#include "harness/base/text.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace harness {

std::string number_text(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string told_apart(double value, double other) {
  constexpr int all_digits = 17;
  int digits = 6;
  if (value != other) {
    while (digits < all_digits && number_text(value, digits) == number_text(other, digits))
      ++digits;
  }
  return number_text(value, digits);
}

std::string step_text(double step) { return std::isnan(step) ? "-" : "1/" + number_text(1 / step); }

std::string duration_text(double seconds) {
  if (seconds < 1) return number_text(1000 * seconds, 3) + " ms";
  if (seconds < 100) return number_text(seconds, 3) + " s";
  const long whole = std::lround(seconds);
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

}  // namespace harness
