// The journal of a sweep, beside its result file: every finished run is a line of it, synced, so
// that whatever ends the program ends no more than one run. A sweep that is taken up again is run
// once more with the journal for a memory: what it remembers is not run, so every decision falls as
// it fell before, and the rest follows.
//
// Lines are JSON: the header {"schema", "pid", "identity", "context"}, then {"point": {...}} for a
// run, {"repeat": key, "seconds": [...], ...} for a repetition (empty: it failed; the rest as
// to_json(Repetition) says) and {"forget": key}.
#pragma once

#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/base/line_journal.h"
#include "harness/run/sweep.h"

namespace harness {

// What has been run already, by what was run.
struct Memory {
  struct Known {
    PointResult point;                   // with its first sample alone
    std::deque<Repetition> repetitions;  // in the order in which they were run
  };
  std::map<std::string, Known> points;

  // Takes over a result file's runs, as if they had just been made.
  void learn(const nlohmann::json& result);
  void forget_failures();
};

class Journal {
 public:
  // As LineJournal.
  explicit Journal(const std::string& out);

  const std::string& path() const { return lines_.path(); }
  const nlohmann::json& header() const { return header_; }  // null: new
  const Memory& memory() const { return memory_; }          // as it was found, what is readable
  const std::string& damage() const { return lines_.damage(); }
  std::size_t points() const { return memory_.points.size(); }

  void start(const nlohmann::json& header);  // empties it first
  // All of these sync, and throw FileError where the disk is full or the file has been removed
  // meanwhile; what was written before is then still whole.
  void add(const PointResult& point);
  void add_repetition(const std::string& key, const Repetition& repetition);
  void forget(const std::string& key);

  void remove() { lines_.remove(); }  // the result file is written: nothing to take up

 private:
  LineJournal lines_;
  nlohmann::json header_;
  Memory memory_;
};

// Runners that look into `memory` first and write what `inner` does to the journal, which must
// outlive them.
SweepRunners journaled(const SweepRunners& inner, Journal& journal, Memory memory);

}  // namespace harness
