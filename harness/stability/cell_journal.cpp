#include "harness/stability/cell_journal.h"

#include "harness/base/errors.h"
#include "harness/stability/trial_json.h"

namespace harness {
namespace {

constexpr const char* journal_schema = "inextensible-stability-journal/1";

}  // namespace

CellJournal::CellJournal(const std::string& out) : lines_(out) {
  lines_.read([this](const nlohmann::json& line, std::size_t number) {
    if (number > 1) {
      cells_[{line.at("case"), line.at("solver")}] = trial_result_of(line.at("result"));
    } else if (line.at("schema") == journal_schema && line.at("identity").is_object()) {
      identity_ = line.at("identity");
    } else {
      throw UsageError("it is not a journal of this program");
    }
  });
}

void CellJournal::learn(const nlohmann::json& result) {
  for (const nlohmann::json& row : result.at("matrix"))
    cells_[{row.at("case"), row.at("solver")}] = trial_result_of(row);
}

void CellJournal::start(const nlohmann::json& identity) {
  identity_ = identity;
  lines_.start({{"schema", journal_schema}, {"identity", identity}});
  for (const auto& [key, result] : cells_) add(key.first, key.second, result);
}

std::optional<TrialResult> CellJournal::find(const std::string& hard_case,
                                             const std::string& solver) const {
  const auto place = cells_.find({hard_case, solver});
  return place == cells_.end() ? std::nullopt : std::optional(place->second);
}

void CellJournal::add(const std::string& hard_case, const std::string& solver,
                      const TrialResult& result) {
  lines_.append({{"case", hard_case}, {"solver", solver}, {"result", to_json(result)}});
}

}  // namespace harness
