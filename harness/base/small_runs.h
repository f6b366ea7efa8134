// Callbacks of a plan of small runs (hard cases, known answers), and the part of a sweep that one
// of several machines runs (--shard).
#pragma once

#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "harness/base/text.h"

namespace harness {

struct RunEvents {
  std::function<bool()> interrupted = [] { return false; };
  // Gives what is known under a key, or what `compute` returns (Journal::once).
  std::function<nlohmann::json(const std::string& key,
                               const std::function<nlohmann::json()>& compute)>
      once = [](const std::string&, const auto& compute) { return compute(); };
  std::function<void(const std::string& key, std::size_t done, std::size_t all)> done =
      [](auto&&...) {};
};

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
