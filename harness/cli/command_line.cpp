#include "harness/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/cli/exit_codes.h"

namespace harness {

Option Option::required() const { return Option(option_->required()); }
namespace {

// A number that is one, and holds the bounds; said as everything else says it.
CLI::Validator within_bounds(const Bounds& bounds) {
  return CLI::Validator(
      [bounds](const std::string& text) {
        char* end = nullptr;
        const double number = std::strtod(text.c_str(), &end);
        if (!text.empty() && *end == '\0' && bounds.hold(number)) return std::string();
        return "is '" + shortened(text, 40) + "', must be " + bounds.text();
      },
      "");
}

}  // namespace

Option Option::positive() const { return holds(Bounds::positive()); }
Option Option::not_negative() const { return holds(Bounds::at_least(0)); }
Option Option::holds(const Bounds& bounds) const {
  return Option(option_->check(within_bounds(bounds)));
}
Option Option::repeatable() const { return Option(option_->allow_extra_args(false)); }
Option Option::within(int least, int most) const {
  return holds(
      {.least = static_cast<double>(least), .most = static_cast<double>(most), .whole = true});
}
Option Option::within(double least, double most) const {
  return holds({.least = least, .most = most});
}

namespace {

template <class Value>
Option add(CLI::App* app, const std::string& name, Value& value, const std::string& help,
           const std::string& type) {
  CLI::Option* option = app->add_option(name == "--out" ? "-o,--out" : name, value, help);
  if (!type.empty()) option->type_name(type);
  return Option(option);
}

}  // namespace

Option Command::option(const std::string& name, std::string& value, const std::string& help,
                       const std::string& type) const {
  return add(app_, name, value, help, type);
}
Option Command::option(const std::string& name, std::vector<std::string>& values,
                       const std::string& help, const std::string& type) const {
  return add(app_, name, values, help, type);
}
Option Command::option(const std::string& name, double& value, const std::string& help,
                       const std::string& type) const {
  return add(app_, name, value, help, type).holds({});
}
Option Command::option(const std::string& name, int& value, const std::string& help,
                       const std::string& type) const {
  return add(app_, name, value, help, type);
}
Option Command::option(const std::string& name, std::int64_t& value, const std::string& help,
                       const std::string& type) const {
  return add(app_, name, value, help, type);
}
namespace {

// Names of version 0.2, which --solver takes for one more version.
std::string renamed(std::string text) {
  for (const auto& [was, is] :
       {std::pair("strips", "yarn_projection"), std::pair("oracle", "dense_newton"),
        std::pair("projective_dynamics", "admm"), std::pair("xpbd_small_steps", "pbd_substeps")}) {
    for (std::size_t at = 0; (at = text.find(was, at)) != std::string::npos;)
      text.replace(at, std::string(was).size(), is);
  }
  return text;
}

}  // namespace

Option Command::alternatives(const std::string& name, std::string& value,
                             const std::string& help) const {
  return Option(app_->add_option(name, value, help)
                    ->type_name("REGEX")
                    ->transform([](std::string text) {
                      std::replace(text.begin(), text.end(), ',', '|');
                      return renamed(std::move(text));
                    })
                    ->delimiter('|')  // they are joined by it again
                    ->multi_option_policy(CLI::MultiOptionPolicy::Join));
}
Option Command::byte_count(const std::string& name, double& value, const std::string& help) const {
  return Option(app_->add_option(name, value, help)
                    ->transform(CLI::AsSizeValue(false).description(""))
                    ->type_name("BYTES"))
      .holds({.least = 1 << 20});
}
void Command::flag(const std::string& name, bool& value, const std::string& help) const {
  app_->add_flag(name, value, help);
}

CommandLine::CommandLine(const std::string& description, const std::vector<Verb>& verbs,
                         std::function<std::string()> version)
    : app_(std::make_unique<CLI::App>(description, "bench")) {
  app_->set_version_flag("-V,--version", std::move(version));
  app_->require_subcommand(0, 1);  // a word after a verb is never another verb: list answers
  for (const Verb& verb : verbs) {
    const bool first = &verb == &verbs.front();
    CLI::App* app = first ? app_.get() : app_->add_subcommand(verb.name, verb.summary);
    app->callback([this, app, name = verb.name, action = verb.add(Command(app, &invocation_))] {
      if (!app->get_subcommands().empty()) return;  // a verb is meant
      invocation_.verb = name;
      invocation_.action = action;
    });
  }
}

CommandLine::~CommandLine() = default;

void CommandLine::add_everywhere(const std::string& name, std::vector<std::string>& values,
                                 const std::string& help, const std::string& type) {
  std::vector<CLI::App*> places = app_->get_subcommands([](const CLI::App*) { return true; });
  places.push_back(app_.get());
  for (CLI::App* place : places) {
    place
        ->add_option_function<std::vector<std::string>>(
            name,
            [&values](const auto& given) {
              values.insert(values.end(), given.begin(), given.end());
            },
            help)
        ->allow_extra_args(false)
        ->type_name(type);
  }
}

namespace {

// As a result records them: it is no place for a machine's folders.
std::vector<std::string> recorded_words(int argc, char** argv) {
  std::vector<std::string> words{"bench"};
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path argument(argv[i]);
    words.push_back(argument.is_absolute() ? argument.filename().string() : argument.string());
  }
  return words;
}

// The words in the order of typing, without the program's name.
std::vector<std::string> usual_words(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return words;
  if (words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  if (words.front() == "sweep") {
    words.front() = "--sweep";
    if (words.size() == 1 || words[1].starts_with('-')) words.erase(words.begin());
  }
  return words;
}

// Help for the verb that was typed, or for the program.
const CLI::App* command_of(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return command;
}

// What is wrong with the first of the typed words that CLI11 had no place for.
std::string not_understood(const CLI::App& program, const std::vector<std::string>& typed) {
  const CLI::App* command = command_of(program);
  const std::vector<std::string> left = program.remaining(true);
  const auto first = std::find_if(typed.begin(), typed.end(), [&left](const std::string& word) {
    return std::find(left.begin(), left.end(), word) != left.end();
  });
  const std::string word = first == typed.end() ? left.front() : *first;
  const std::string of = command == &program ? "" : " of bench " + command->get_name();
  std::vector<std::string> known;
  std::string message;
  if (word.starts_with('-')) {
    for (const CLI::Option* option : command->get_options())
      for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
    message = "no option '" + shortened(word, 40) + "'" + of;
  } else if (command == &program) {
    for (const CLI::App* sub : program.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(sub->get_name());
    message = "no command '" + shortened(word, 40) + "'";
  } else {
    return "unexpected argument '" + shortened(word, 40) + "'" + of;
  }
  const std::string meant = closest(word.substr(0, word.find('=')), known);
  return message + (meant.empty() ? "" : "; did you mean '" + meant + "'?");
}

}  // namespace

std::optional<int> CommandLine::read(int argc, char** argv) {
  const std::vector<std::string> words = usual_words(argc, argv);
  invocation_.words = recorded_words(argc, argv);
  const auto refused = [this](const std::string& why) {
    const CLI::App* command = command_of(*app_);
    std::cerr << "bench: " << why << " (see bench "
              << (command == app_.get() ? "" : command->get_name() + " ") << "--help)\n";
    return usage_error;
  };
  try {
    app_->parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as CLI11 takes them
  } catch (const CLI::ExtrasError&) {
    return refused(not_understood(*app_, words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refused(error.what());
    const bool no_verb = !words.front().starts_with('-') && app_->get_subcommands().empty();
    if (no_verb) return refused(not_understood(*app_, words));  // help of what is not there
    return app_->exit(error);                                   // --help, --version
  }
  return std::nullopt;
}

}  // namespace harness
