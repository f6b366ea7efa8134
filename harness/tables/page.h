// The tables of docs/results.md, one file a family: what they share, and what each prints.
#pragma once

#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "harness/analysis/measured_point.h"
#include "harness/tables/results_page.h"

namespace harness::tables {

using namespace analysis;  // tables print what was analysed

// ---- shared (page.cpp) ----
void print_row(std::ostream& out, const std::vector<std::string>& cells);
void print_head(std::ostream& out, const std::vector<std::string>& cells);
std::string quoted(const std::string& name);
std::string bold(const std::string& text);
// As number_text(), but never with a power of ten where the number has more digits.
std::string plain(double value, int digits);
bool is_stability(const nlohmann::json& document);

// The fastest runs of a scene's contestants over the strain limit.
class LimitTable {
 public:
  // Reads the runs that a file marked as fastest in strain sweeps of one scene and size.
  LimitTable(const nlohmann::json& document, const std::string& scene);

  bool empty() const { return limits_.empty(); }
  const std::vector<double>& limits() const { return limits_; }  // loose to tight
  const Point& any() const { return cells_.begin()->second; }
  using Cell = std::function<std::string(const Point&)>;
  void print(std::ostream& out, const std::function<std::string(double)>& head,
             const Cell& cell) const;

 private:
  std::vector<std::string> contestants_;  // in the file's order, those that are ranked
  std::vector<double> limits_;
  std::map<std::pair<std::string, double>, Point> cells_;
};

// ---- families of tables ----
void print_planes(std::ostream& out, const std::vector<NamedResult>& results);
void print_growth(std::ostream& out, const std::vector<NamedResult>& results);
void print_sag(std::ostream& out, const NamedResult& result);
void print_slip(std::ostream& out, const NamedResult& result);
void print_answers(std::ostream& out, const NamedResult& result);
void print_hard_cases(std::ostream& out, const NamedResult& result);
void print_sources(std::ostream& out, const std::vector<NamedResult>& results);

}  // namespace harness::tables
