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
  std::size_t names = 1;  // this many of the first columns hold names, which Markdown sets as code
};

// No text of a cell ends the cell or its code, or begins a tag.
inline void print_markdown(std::ostream& out, const Table& table) {
  const auto cell = [](const std::string& text, bool code) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool tag =
          text[i] == '<' && i + 1 < text.size() && text[i + 1] != '=' && text[i + 1] != ' ';
      result += text[i] == '|'           ? "\\|"
                : text[i] == '`' && code ? "'"
                : tag && !code           ? "&lt;"
                                         : std::string(1, text[i]);
    }
    return code ? '`' + result + '`' : result;
  };
  const auto print_row = [&](const std::vector<std::string>& cells, std::size_t names) {
    out << '|';
    for (std::size_t i = 0; i < cells.size(); ++i) out << ' ' << cell(cells[i], i < names) << " |";
    out << '\n';
  };
  print_row(table.head, 0);
  out << '|';
  for (std::size_t i = 0; i < table.head.size(); ++i) out << "---|";
  out << '\n';
  for (const auto& row : table.rows) print_row(row, table.names);
}

// Columns are as wide as their cells need; the last cell of a row may be wider than its column.
inline void print_aligned(std::ostream& out, const Table& table) {
  std::vector<std::vector<std::string>> rows = table.rows;
  if (!table.head.empty()) rows.insert(rows.begin(), table.head);
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      widths[i] = std::max(widths[i], row[i].size() + 2);
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line.append(widths[i] - row[i].size(), ' ');
    }
    out << line << '\n';
  }
}

// The distinct values of key(item), in order of first appearance.
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
