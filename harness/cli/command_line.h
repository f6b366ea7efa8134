// What a verb is, and how it says which options it has.
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
using Numbers = std::vector<double>;

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

  using Place = std::variant<std::reference_wrapper<std::string>, std::reference_wrapper<Words>,
                             std::reference_wrapper<Numbers>, std::reference_wrapper<double>,
                             std::reference_wrapper<int>, std::reference_wrapper<std::int64_t>>;

  // An option if the name begins with dashes, a word in its place if not. `type`: what the help
  // calls the value. Numbers stand between commas, and the bounds hold for each.
  void option(const std::string& name, Place place, const std::string& help,
              const std::string& type, const Bounds& bounds = {}) const;
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

}  // namespace harness
