// A table, for a page or for a terminal.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
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

}  // namespace harness
