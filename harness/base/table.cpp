#include "harness/base/table.h"

namespace harness {
namespace {

void print_row(std::ostream& out, const std::vector<std::string>& cells, std::size_t names = 0) {
  out << '|';
  for (std::size_t i = 0; i < cells.size(); ++i)
    out << ' ' << (i < names ? '`' + cells[i] + '`' : cells[i]) << " |";
  out << '\n';
}

}  // namespace

void print_markdown(std::ostream& out, const Table& table) {
  print_row(out, table.head);
  out << '|';
  for (std::size_t i = 0; i < table.head.size(); ++i) out << "---|";
  out << '\n';
  for (const auto& row : table.rows) print_row(out, row, table.names);
}

void print_aligned(std::ostream& out, const Table& table) {
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

}  // namespace harness
