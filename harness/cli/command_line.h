// Verbs and how they declare their options.
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

std::optional<double> number_in(const std::string& text);  // none unless it is one number

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

// A verb's options are added to it. The variables that they set must outlive the verb's run.
class Command {
 public:
  explicit Command(CLI::App* app = nullptr, std::string group = {})
      : app_(app), group_(std::move(group)) {}

  using Place = std::variant<std::reference_wrapper<std::string>, std::reference_wrapper<Words>,
                             std::reference_wrapper<Numbers>, std::reference_wrapper<double>,
                             std::reference_wrapper<int>, std::reference_wrapper<std::int64_t>>;

  // An option if the name begins with dashes, else a positional argument. `type`: the value's name
  // in the help. Numbers are separated by commas, and the bounds apply to each.
  void option(const std::string& name, Place place, const std::string& help,
              const std::string& type, const Bounds& bounds = {}) const;
  // One value each time, whereas option() with Words takes all words that follow.
  void repeatable(const std::string& name, Words& values, const std::string& help,
                  const std::string& type) const;
  // A regular expression; several, repeated or separated by commas, are alternatives.
  void alternatives(const std::string& name, std::string& value, const std::string& help) const;
  // "4G" is 4 GiB.
  void byte_count(const std::string& name, double& value, const std::string& help) const;
  void flag(const std::string& name, bool& value, const std::string& help) const;

  void require(std::initializer_list<const char*> names) const;
  // Options under a heading of their own in the help. one_typed(): one that was given, or "".
  Command group(const std::string& heading) const { return Command(app_, heading); }
  const std::string& heading() const { return group_; }
  std::string one_typed() const;

 private:
  CLI::Option* placed(CLI::Option* option) const;

  CLI::App* app_;
  std::string group_;
};

// `add` adds the verb's options and returns its action.
struct Verb {
  std::string name, summary;
  Action (*add)(const Command& command);
  // It computes in child processes, and an interruption leaves a partial result.
  bool has_children = false;
};

// The action of a verb given as a struct: declare() adds its members as options, run() acts, and
// may take the typed words for the record.
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
