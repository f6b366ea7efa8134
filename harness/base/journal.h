// The journal beside an output: what has been computed, each result by its key, synced one line of
// JSON at a time, so that whatever ends the program costs one result at most.
//
// A line is {"header": ...}, {"key": ..., "value": ...} or {"forget": key}, each with "check", a
// hash of the rest. The last header counts; damage before it is ignored.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/files.h"

namespace harness {

class Journal {
 public:
  // Opens or makes the journal of the output file `out`, reads it, and holds it until the
  // destructor, which removes it if it is empty. Throws UsageError if another process holds it.
  explicit Journal(const std::string& out);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::string& path() const { return path_; }
  const std::string& damage() const { return damage_; }     // "": every whole line is sound
  const nlohmann::json& header() const { return header_; }  // null: there is none
  const std::map<std::string, nlohmann::json>& known() const { return known_; }
  // Null: not known. Valid until the key is added again or forgotten.
  const nlohmann::json* find(const std::string& key) const;

  // These throw FileError on a full disk or a removed file; what was written before is whole.
  void start(const nlohmann::json& header);  // drops what is known
  void go_on(const nlohmann::json& header);  // keeps it
  const nlohmann::json& add(const std::string& key, nlohmann::json value);
  // The known value, or what `compute` returns, which is added.
  const nlohmann::json& once(const std::string& key,
                             const std::function<nlohmann::json()>& compute);
  void forget(const std::string& key);
  void remove();  // the output is written: there is nothing to resume

 private:
  void lock(const std::string& out);
  void read();
  void append(nlohmann::json line);

  std::string path_, damage_;
  nlohmann::json header_;
  std::map<std::string, nlohmann::json> known_;
  OpenFile file_;
  std::size_t length_ = 0;  // bytes, whole lines
};

// Callbacks of a plan of small runs: hard cases, known answers.
struct RunEvents {
  std::function<bool()> interrupted = [] { return false; };
  // Gives what is known under a key, or what `compute` returns (Journal::once).
  std::function<nlohmann::json(const std::string& key,
                               const std::function<nlohmann::json()>& compute)>
      once = [](const std::string&, const auto& compute) { return compute(); };
  std::function<void(const std::string& key, std::size_t done, std::size_t all)> done =
      [](auto&&...) {};
};

}  // namespace harness
