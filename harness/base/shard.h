// A part of a sweep, for several machines (--shard).
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "harness/base/text.h"

namespace harness {

// The index-th, from 1 on, of count parts.
struct Shard {
  std::size_t index = 1, count = 1;

  // Keeps one stretch of a list: the stretches of all parts, in order, are the list.
  template <class T>
  void keep(std::vector<T>& list) const {
    const auto part = [&](std::size_t i) {
      return list.begin() + static_cast<std::ptrdiff_t>(list.size() * i / count);
    };
    list = std::vector<T>(part(index - 1), part(index));
  }
};

// "2/5"; throws UsageError unless 1 <= i <= N.
inline Shard parse_shard(const std::string& text) {
  Shard shard;
  if (!has_form(text, R"(\d{1,6}/\d{1,6})") ||
      std::sscanf(text.c_str(), "%zu/%zu", &shard.index, &shard.count) != 2)
    throw UsageError("--shard is '" + shortened(text) + "', must be i/N, such as 2/5");
  if (shard.index < 1 || shard.index > shard.count)
    throw UsageError("--shard is '" + text + "', but i must be from 1 to N");
  return shard;
}

}  // namespace harness
