// What the tables of docs/results.md share.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "harness/analysis/measured_point.h"
#include "harness/tables/results_page.h"
#include "harness/tables/table.h"

namespace harness::tables {

using namespace analysis;  // tables print what was analysed

inline std::string quoted(const std::string& name) { return '`' + name + '`'; }
// As number_text(), but never with a power of ten where the number has more digits.
std::string plain(double value, int digits);
bool is_stability(const nlohmann::json& document);

// The plane strain x error of each scene: the fastest method within each limit and level of error.
void print_planes(std::ostream& out, const std::vector<NamedResult>& results);

}  // namespace harness::tables
