// A table, for a page or for a terminal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace harness {

struct Table {
  std::vector<std::string> head;  // may be empty on a terminal
  std::vector<std::vector<std::string>> rows = {};
  std::size_t names = 1;  // so many of the first columns hold names, which Markdown sets as code
};

void print_markdown(std::ostream& out, const Table& table);
// Columns are as wide as their cells need; the last cell of a row may be wider than its column.
void print_aligned(std::ostream& out, const Table& table);

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
