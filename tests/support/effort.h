// How much tests do with sanitizers, which look at memory and not at mathematics, and make each
// many times as slow.
#pragma once

namespace inextensible::testing {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

// How many random trials, or steps, of `n` are made.
template <class Int>
constexpr Int trials(Int n) {
  return sanitized ? (n + 7) / 8 : n;
}

}  // namespace inextensible::testing
