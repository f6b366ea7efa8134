// The words on the command line. CLI11 reads them. Only command_line.cpp includes it, because every
// file that does takes ten seconds to compile.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/bounds.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace harness {

using Action = std::function<int()>;  // returns an ExitCode; throws UsageError

// What was typed: all words, for the record, and the action of the verb among them.
struct Invocation {
  std::vector<std::string> words;
  std::string verb;
  Action action;
};

// An option that was just added, to say more of it.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option required() const;
  Option holds(const Bounds& bounds) const;
  Option positive() const;
  Option not_negative() const;
  Option repeatable() const;  // one value each time; else a list takes all words that follow
  Option within(int least, int most) const;
  Option within(double least, double most) const;

 private:
  CLI::Option* option_;
};

// Where a verb adds its options. What an option is written to must live until the action has run,
// which is why actions share their options' owner.
class Command {
 public:
  Command(CLI::App* app, const Invocation* invocation) : app_(app), invocation_(invocation) {}

  // An option if the name begins with dashes, a word in its place if not. `type`: what the help
  // calls the value.
  Option option(const std::string& name, std::string& value, const std::string& help,
                const std::string& type = {}) const;
  Option option(const std::string& name, std::vector<std::string>& values, const std::string& help,
                const std::string& type) const;
  Option option(const std::string& name, double& value, const std::string& help,
                const std::string& type) const;
  Option option(const std::string& name, int& value, const std::string& help,
                const std::string& type) const;
  Option option(const std::string& name, std::int64_t& value, const std::string& help,
                const std::string& type) const;
  // A regular expression; of several, given one by one or between commas, what matches one of them.
  Option alternatives(const std::string& name, std::string& value, const std::string& help) const;
  // "4G" is 4 GiB.
  Option byte_count(const std::string& name, double& value, const std::string& help) const;
  void flag(const std::string& name, bool& value, const std::string& help) const;

  // The words of the command line, for the record: ask when the action runs.
  const std::vector<std::string>& words() const { return invocation_->words; }

 private:
  CLI::App* app_;
  const Invocation* invocation_;
};

// A verb of the program. `add` adds its options, and returns what is done if it is chosen.
struct Verb {
  std::string name, summary;
  Action (*add)(const Command& command);
};

class CommandLine {
 public:
  // version: asked for by -V and --version. Options of the first verb are the program's own, which
  // goes without a name: its first option has that.
  CommandLine(const std::string& description, const std::vector<Verb>& verbs,
              std::function<std::string()> version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // Before and after the name of every verb, any number of times.
  void add_everywhere(const std::string& name, std::vector<std::string>& values,
                      const std::string& help, const std::string& type);

  // `help VERB` is VERB --help, and `sweep AXIS` is --sweep AXIS. An exit code if nothing is left
  // to do: help was printed, or a word is wrong, which is said on stderr.
  std::optional<int> read(int argc, char** argv);
  int run() const { return invocation_.action(); }
  const std::string& verb() const { return invocation_.verb; }  // that was typed

 private:
  std::unique_ptr<CLI::App> app_;
  Invocation invocation_;
};

}  // namespace harness
