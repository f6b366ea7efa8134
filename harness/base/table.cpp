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

void print_aligned(std::ostream& out, const Table& table, std::size_t most) {
  std::vector<std::vector<std::string>> rows = table.rows;
  if (!table.head.empty()) rows.insert(rows.begin(), table.head);
  std::vector<std::size_t> widths;
  for (const auto& row : rows) widths.resize(std::max(widths.size(), row.size()));
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i + 1 < row.size() || i + 1 == widths.size())
        widths[i] = std::max(widths[i], row[i].size() + 2);
    }
  }
  for (std::size_t first = 0, last = 0; last < widths.size(); first = last) {
    std::size_t total = first > 0 ? widths[0] : 0;
    do {
      total += widths[last++];
    } while (last < widths.size() && total + widths[last] <= most);
    if (first > 0) out << '\n';
    for (const auto& row : rows) {
      std::string line = first > 0 ? row[0] : "";
      std::size_t end = first > 0 ? widths[0] : 0;
      for (std::size_t i = first; i < std::min(last, row.size()); end += widths[i++]) {
        line.resize(std::max(line.size(), end), ' ');
        line += row[i];
      }
      out << line << '\n';
    }
  }
}

}  // namespace harness
