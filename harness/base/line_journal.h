// A journal beside an output: one line of JSON for each thing that is done, synced, so that
// whatever ends the program ends no more than one of them. The first line is a header.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace harness {

class LineJournal {
 public:
  // Opens or makes the journal of the output file `out`, and holds it against other processes until
  // the destructor, which removes it if nothing has come of it. Throws UsageError if another
  // process is writing this output.
  explicit LineJournal(const std::string& out);
  ~LineJournal();
  LineJournal(const LineJournal&) = delete;
  LineJournal& operator=(const LineJournal&) = delete;

  // Every whole line, with its number from 1 on. One that is no JSON, or that `learn` throws on, is
  // passed over; the first such becomes the damage. Once, before anything is written.
  void read(const std::function<void(const nlohmann::json& line, std::size_t number)>& learn);

  const std::string& path() const { return path_; }
  const std::string& damage() const { return damage_; }  // "" if nothing is wrong with it

  void start(const nlohmann::json& header);  // empties it first
  // Synced. Throws FileError where the disk is full or the file has been removed meanwhile; what
  // was written before is then still whole.
  void append(const nlohmann::json& line);
  void remove();  // the output is written: nothing to take up

 private:
  void lock(const std::string& out);

  std::string path_, damage_;
  int file_ = -1;
  std::size_t length_ = 0;  // bytes, whole lines
};

}  // namespace harness
