// The one rule for numbers that come from outside, on the command line or in a file.
#pragma once

#include <string>

namespace harness {

// What a number must be.
struct Bounds {
  static constexpr double huge = 1e300;  // as a bound: none

  double least = -huge;
  bool above = false;  // least itself is not allowed
  double most = huge;
  bool below = false;  // most itself is not allowed
  bool whole = false;

  static Bounds positive() { return {.least = 0, .above = true}; }
  // A strain limit: at 1 an edge may vanish.
  static Bounds strain() { return {.least = 0, .above = true, .most = 1, .below = true}; }
  static Bounds at_least(double least) { return {.least = least}; }
  // One that fits into an int.
  static Bounds whole_number(double least) {
    return {.least = least, .most = 2147483647, .whole = true};
  }
  // One that a double holds exactly, for seeds.
  static Bounds exact_number() { return {.least = 0, .most = 9007199254740992, .whole = true}; }
  std::string text() const;  // "a whole number of at least 2"
  bool hold(double number) const;
};

}  // namespace harness
