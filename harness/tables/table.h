// A table, for a page or for a terminal.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace harness {

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

void print_markdown(std::ostream& out, const Table& table);
// Columns are as wide as their cells need; the last cell of a row may be wider than its column.
void print_aligned(std::ostream& out, const Table& table);

}  // namespace harness
