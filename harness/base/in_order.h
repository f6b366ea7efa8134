#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

namespace harness {

// The different values of key(item), in order of first appearance.
template <class Items, class Key>
auto in_order(const Items& items, Key key) {
  std::vector<std::decay_t<decltype(key(*items.begin()))>> keys;
  for (const auto& item : items) {
    auto value = key(item);
    if (std::find(keys.begin(), keys.end(), value) == keys.end()) keys.push_back(std::move(value));
  }
  return keys;
}

}  // namespace harness
