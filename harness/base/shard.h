// A part of a sweep, for several machines (--shard).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace harness {

// The index-th, from 1 on, of count parts.
struct Shard {
  std::size_t index = 1, count = 1;

  // Keeps one stretch of a list: the stretches of all parts, in order, are the list.
  template <class T>
  void keep(std::vector<T>& list) const {
    const std::size_t begin = list.size() * (index - 1) / count, end = list.size() * index / count;
    list = std::vector<T>(list.begin() + static_cast<std::ptrdiff_t>(begin),
                          list.begin() + static_cast<std::ptrdiff_t>(end));
  }
};
// "2/5"; throws UsageError unless 1 <= i <= N.
Shard parse_shard(const std::string& text);

}  // namespace harness
