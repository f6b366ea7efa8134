// The journal of a stability sweep, beside its result file: a line for each cell that has been run,
// synced. Lines are JSON: the header {"schema", "identity"}, then {"case", "solver", "result"}.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "harness/base/line_journal.h"
#include "harness/stability/trial.h"

namespace harness {

class CellJournal {
 public:
  // As LineJournal; learns what a run that did not finish has left.
  explicit CellJournal(const std::string& out);

  const std::string& path() const { return lines_.path(); }
  const std::string& damage() const { return lines_.damage(); }
  std::size_t cells() const { return cells_.size(); }
  const nlohmann::json& identity() const { return identity_; }  // null: new, or its header is lost

  // Takes over the cells of an incomplete result file, as if they had just been run.
  void learn(const nlohmann::json& result);
  void forget() { cells_.clear(); }

  // Rewrites the file with the cells that it has. This and add throw FileError.
  void start(const nlohmann::json& identity);
  std::optional<TrialResult> find(const std::string& hard_case, const std::string& solver) const;
  void add(const std::string& hard_case, const std::string& solver, const TrialResult& result);
  void remove() { lines_.remove(); }  // the result file is written: nothing to take up

 private:
  LineJournal lines_;
  nlohmann::json identity_;
  std::map<std::pair<std::string, std::string>, TrialResult> cells_;
};

}  // namespace harness
