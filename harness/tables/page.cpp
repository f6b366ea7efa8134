#include "harness/tables/page.h"

#include <algorithm>
#include <cmath>

#include "harness/base/in_order.h"
#include "harness/base/text.h"

namespace harness::tables {

using nlohmann::json;

void print_row(std::ostream& out, const std::vector<std::string>& cells) {
  out << '|';
  for (const std::string& cell : cells) out << ' ' << cell << " |";
  out << '\n';
}

void print_head(std::ostream& out, const std::vector<std::string>& cells) {
  print_row(out, cells);
  out << '|';
  for (std::size_t i = 0; i < cells.size(); ++i) out << "---|";
  out << '\n';
}

std::string quoted(const std::string& name) { return '`' + name + '`'; }

std::string bold(const std::string& words) { return "**" + words + "**"; }

std::string plain(double value, int digits) {
  const bool large = value >= 1 && std::isfinite(value);
  const int whole = large ? static_cast<int>(std::log10(value)) + 1 : 1;
  return number_text(value, std::max(digits, whole));
}

bool is_stability(const json& document) { return document.contains("matrix"); }

LimitTable::LimitTable(const json& document, const std::string& scene) {
  if (is_stability(document)) return;
  const ContestantRoles roles(document);
  for (const json& p : document.at("points")) {
    if (p.at("sweep") != "strain" || p.value("adaptive", false) || p.at("scene") != scene) continue;
    const Point point(p);
    if (!point.ok() || !point.flag("best") || !roles.of(point.contestant()).ranked()) continue;
    contestants_.push_back(point.contestant());
    limits_.push_back(point.number("strain_limit"));
    cells_.try_emplace({point.contestant(), limits_.back()}, point);
  }
  const auto itself = [](const auto& value) { return value; };
  contestants_ = in_order(contestants_, itself);
  limits_ = in_order(limits_, itself);
  std::sort(limits_.rbegin(), limits_.rend());
}

void LimitTable::print(std::ostream& out, const std::function<std::string(double)>& head,
                       const Cell& cell) const {
  std::vector<std::string> row{"solver"};
  for (const double limit : limits_) row.push_back(head(limit));
  print_head(out, row);
  for (const std::string& contestant : contestants_) {
    row = {quoted(contestant)};
    for (const double limit : limits_) {
      const auto found = cells_.find({contestant, limit});
      row.push_back(found == cells_.end() ? "-" : cell(found->second));
    }
    print_row(out, row);
  }
  out << '\n';
}

}  // namespace harness::tables
