#include "harness/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/text.h"

namespace harness {
namespace {

// A number that is one, and holds the bounds; said as everything else says it.
CLI::Validator within(const Bounds& bounds) {
  return CLI::Validator(
      [bounds](const std::string& text) {
        const auto number = number_in(text);
        if (number && bounds.hold(*number)) return std::string();
        return "is '" + shortened(text, 40) + "', must be " + bounds.text();
      },
      "");
}

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

// As a result records them: it is no place for a machine's folders.
Words recorded_words(int argc, char** argv) {
  Words words{"bench"};
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path argument(argv[i]);
    words.push_back(argument.is_absolute() ? argument.filename().string() : argument.string());
  }
  return words;
}

// The words in the order of typing, without the program's name.
Words usual_words(int argc, char** argv) {
  Words words(argv + std::min(argc, 1), argv + argc);
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
std::string not_understood(const CLI::App& program, const Words& typed) {
  const CLI::App* command = command_of(program);
  const Words left = program.remaining(true);
  const auto first = std::ranges::find_if(typed, [&left](const std::string& word) {
    return std::ranges::find(left, word) != left.end();
  });
  const std::string word = first == typed.end() ? left.front() : *first;
  const std::string of = command == &program ? "" : " of bench " + command->get_name();
  Words known;
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

std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return text.empty() || *end != '\0' ? std::nullopt : std::optional(number);
}

CLI::Option* Command::placed(CLI::Option* option) const {
  return group_.empty() ? option : option->group(group_);
}

void Command::add(const std::string& name, Place place, const std::string& help,
                  const std::string& type, const Bounds& bounds) const {
  std::visit(
      [&](auto* value) {
        CLI::Option* option =
            placed(app_->add_option(name == "--out" ? "-o,--out" : name, *value, help));
        option->type_name(type);
        if constexpr (std::is_arithmetic_v<std::remove_pointer_t<decltype(value)>>)
          option->check(within(bounds));
      },
      place);
}

void Command::repeatable(const std::string& name, Words& values, const std::string& help,
                         const std::string& type) const {
  placed(app_->add_option(name, values, help))->type_name(type)->allow_extra_args(false);
}

void Command::alternatives(const std::string& name, std::string& value,
                           const std::string& help) const {
  placed(app_->add_option(name, value, help))
      ->type_name("REGEX")
      ->transform([](std::string text) {
        std::replace(text.begin(), text.end(), ',', '|');
        return renamed(std::move(text));
      })
      ->delimiter('|')  // they are joined by it again
      ->multi_option_policy(CLI::MultiOptionPolicy::Join);
}

void Command::byte_count(const std::string& name, double& value, const std::string& help) const {
  placed(app_->add_option(name, value, help))
      ->transform(CLI::AsSizeValue(false).description(""))
      ->type_name("BYTES")
      ->check(within({.least = 1 << 20}));
}

void Command::flag(const std::string& name, bool& value, const std::string& help) const {
  placed(app_->add_flag(name, value, help));
}

void Command::require(std::initializer_list<const char*> names) const {
  for (const char* name : names) app_->get_option(name)->required();
}

std::string Command::one_typed() const {
  for (const CLI::Option* option : app_->get_options()) {
    if (option->get_group() == group_ && option->count() > 0) return option->get_name();
  }
  return "";
}

CommandLine::CommandLine(const std::string& description, const std::vector<Verb>& verbs,
                         std::function<std::string()> version)
    : app_(std::make_unique<CLI::App>(description, "bench")) {
  app_->set_version_flag("-V,--version", std::move(version));
  app_->require_subcommand(0, 1);  // a word after a verb is never another verb: list answers
  for (const Verb& verb : verbs) {
    const bool first = &verb == &verbs.front();
    CLI::App* app = first ? app_.get() : app_->add_subcommand(verb.name, verb.summary);
    app->callback([this, app, has_children = verb.has_children, action = verb.add(Command(app))] {
      if (!app->get_subcommands().empty()) return;  // a verb is meant
      action_ = action;
      has_children_ = has_children;
    });
    app->add_option_function<Words>(
           "--plugin",
           [this](const Words& files) {
             plugins_.insert(plugins_.end(), files.begin(), files.end());
           },
           "load solvers of your own from a shared library (solvers/plugin.h); repeatable")
        ->allow_extra_args(false)
        ->type_name("FILE");
  }
}

CommandLine::~CommandLine() = default;

std::optional<int> CommandLine::read(int argc, char** argv) {
  const Words words = usual_words(argc, argv);
  words_ = recorded_words(argc, argv);
  const auto refused = [this](const std::string& why) {
    const CLI::App* command = command_of(*app_);
    std::cerr << "bench: " << why << " (see bench "
              << (command == app_.get() ? "" : command->get_name() + " ") << "--help)\n";
    return usage_error;
  };
  try {
    app_->parse(Words(words.rbegin(), words.rend()));  // as CLI11 takes them
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
