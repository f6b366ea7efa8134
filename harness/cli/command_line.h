// The words on the command line. CLI11 reads them. Only command_line.cpp includes it, because every
// file that does takes ten seconds to compile.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/base/json.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace harness {

using Words = std::vector<std::string>;

std::optional<double> number_in(const std::string& text);  // none: it is not a number alone

// docs/using.md explains them.
enum ExitCode {
  success = 0,
  internal_error = 1,
  usage_error = 2,
  regression = 3,
  unexpected_outcome = 4,
  not_comparable = 5,
  cannot_decide = 6,
  interrupted_exit = 130
};

using Action = std::function<int(const Words& typed)>;  // returns an ExitCode

// Where a verb adds its options. What an option is written to must outlive the verb's run.
class Command {
 public:
  explicit Command(CLI::App* app = nullptr, std::string group = {})
      : app_(app), group_(std::move(group)) {}

  // An option if the name begins with dashes, a word in its place if not. `type`: what the help
  // calls the value, which is a string, Words, a double, an int or an int64_t.
  template <class Value>
  void option(const std::string& name, Value& value, const std::string& help,
              const std::string& type, const Bounds& bounds = {}) const {
    add(name, &value, help, type, bounds);
  }
  // One value each time; Words as an option take all words that follow.
  void repeatable(const std::string& name, Words& values, const std::string& help,
                  const std::string& type) const;
  // A regular expression; of several, given one by one or between commas, what matches one of them.
  void alternatives(const std::string& name, std::string& value, const std::string& help) const;
  // "4G" is 4 GiB.
  void byte_count(const std::string& name, double& value, const std::string& help) const;
  void flag(const std::string& name, bool& value, const std::string& help) const;

  void require(std::initializer_list<const char*> names) const;
  // Options that the help lists under a heading of their own; which of them was typed, if any.
  Command group(const std::string& heading) const { return Command(app_, heading); }
  const std::string& heading() const { return group_; }
  std::string one_typed() const;

 private:
  using Place = std::variant<std::string*, Words*, double*, int*, std::int64_t*>;
  void add(const std::string& name, Place place, const std::string& help, const std::string& type,
           const Bounds& bounds) const;
  CLI::Option* placed(CLI::Option* option) const;

  CLI::App* app_;
  std::string group_;
};

// A verb of the program. `add` adds its options, and returns what is done if it is chosen.
struct Verb {
  std::string name, summary;
  Action (*add)(const Command& command);
  // It computes in children of its own, and answers an interruption with what was done until then.
  bool has_children = false;
};

// The action of a verb whose options are the members of a struct, which adds them in declare() and
// acts in run(), with the words of the command line for the record where it asks for them.
template <class Options>
Action verb(const Command& command) {
  const auto options = std::make_shared<Options>();
  options->declare(command);
  return [options](const Words& typed) {
    if constexpr (requires { options->run(typed); })
      return options->run(typed);
    else
      return options->run();
  };
}

class CommandLine {
 public:
  // version: asked for by -V and --version. Options of the first verb are the program's own, which
  // goes without a name: its first option has that.
  CommandLine(const std::string& description, const std::vector<Verb>& verbs,
              std::function<std::string()> version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // `help VERB` is VERB --help, and `sweep AXIS` is --sweep AXIS. An exit code if nothing is left
  // to do: help was printed, or a word is wrong, which is said on stderr.
  std::optional<int> read(int argc, char** argv);
  int run() const { return action_(words_); }
  bool has_children() const { return has_children_; }  // of the verb that was typed
  const Words& plugins() const { return plugins_; }    // of --plugin, which every verb takes

 private:
  std::unique_ptr<CLI::App> app_;
  Words words_, plugins_;
  Action action_;
  bool has_children_ = false;
};

}  // namespace harness
