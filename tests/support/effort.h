// Sanitizers examine memory, not mathematics, and make tests many times slower: fewer trials do.
#pragma once

namespace inextensible::testing {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

// How many of n random trials, or steps, are made.
template <class Int>
constexpr Int trials(Int n) {
  return sanitized ? (n + 7) / 8 : n;
}

}  // namespace inextensible::testing
