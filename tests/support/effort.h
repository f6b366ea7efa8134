#pragma once

namespace inextensible::testing {

// How many random trials of `n` are made: an eighth of them with sanitizers, which look at memory
// and not at mathematics, and make each many times as slow.
template <class Int>
constexpr Int trials(Int n) {
#ifdef __SANITIZE_ADDRESS__
  return n / 8;
#else
  return n;
#endif
}

}  // namespace inextensible::testing
