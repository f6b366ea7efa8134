// bench: the command line. Only this file includes CLI11, which takes ten seconds to compile.
#include <CLI/CLI.hpp>
#include <cstdlib>

#include "harness/base/child_process.h"
#include "harness/cli/command.h"
#include "harness/compare/comparison.h"
#include "harness/points/context.h"
#include "harness/points/plugins.h"

namespace harness {
namespace {

// A number within bounds, with the message that files get too.
CLI::Validator within(const Bounds& bounds) {
  return CLI::Validator(
      [bounds](const std::string& text) {
        const auto number = number_in(text);
        if (number && bounds.hold(*number)) return std::string();
        return "is '" + shortened(text, 40) + "', must be " + bounds.text();
      },
      "");
}

// For the record in a result, which must not name folders of this machine.
Words recorded_words(int argc, char** argv) {
  Words words{"bench"};
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path argument(argv[i]);
    words.push_back(argument.is_absolute() ? argument.filename().string() : argument.string());
  }
  return words;
}

// The typed words without the program's name; `help VERB` and `sweep AXIS` become options.
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

// The verb that was typed, or the program.
const CLI::App* command_of(const CLI::App& program) {
  const auto typed = program.get_subcommands();
  return typed.empty() ? &program : typed.front();
}

std::string not_understood(const CLI::App& program, const Words& typed) {
  const CLI::App* command = command_of(program);
  const Words left = program.remaining(true);
  const auto first = std::ranges::find_first_of(typed, left);
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

constexpr const char* description =
    "bench: benchmark of solvers for inextensible cloth and chains: time at each strain limit, "
    "error and size.\n"
    "\n"
    "  bench --sweep strain                     Figures 4a and 5a of Goldenthal et al. 2007\n"
    "  bench --sweep strain --profile quick     a first look\n"
    "  bench --sweep resolution --scene chain   Figure 4b\n"
    "  bench --sweep step --scene chain         time against error\n"
    "  bench --sweep stability                  hard cases: which solver fails where\n"
    "  bench show RESULT.json                   the result in two sentences, and its table\n"
    "  bench help VERB                          the options of a verb (SUBCOMMANDS, below)\n";

std::string version_text() {
  const json build = machine_context().at("build");
  const std::string commit = build.at("git");
  return std::string("bench ") + version() +
         (commit.empty() ? "" : ", commit " + commit.substr(0, 12)) +
         (build.at("dirty").get<bool>() ? " with changes" : "") + ", " +
         build.at("type").get<std::string>() + " by " + build.at("compiler").get<std::string>() +
         " with " + build.at("flags").get<std::string>() +
         "\nThe source is MIT licensed. This program links GSL and parts of SuiteSparse, and is as "
         "a whole\nunder the GNU GPL, version 3 or later (NOTICE). There is no warranty.";
}

void load(const Words& plugins) {
  {
    const OutputToError no_output;
    for (const std::string& file : plugins) load_plugin(file);
  }
  for (const Plugin& plugin : loaded_plugins())
    if (!plugin.optimized)
      std::cerr << "bench: plug-in '" << plugin.file
                << "' was compiled without optimization: its times are meaningless\n";
}

int failed(const std::string& why, ExitCode code) {
  std::cerr << "bench: " << why << '\n';
  return code;
}

int guarded(const std::function<int()>& work) {
  try {
    const int code = work();
    check_standard_output();
    send_output_to_error();  // what plug-ins print as they are unloaded
    return code;
  } catch (const UsageError& error) {
    return failed(error.what(), usage_error);
  } catch (const json::exception& error) {
    // Schemas are checked where files are read; what a schema leaves open is reported here.
    return failed(std::string("a value in a file has the wrong type: ") + error.what(),
                  usage_error);
  } catch (const NotComparable& reason) {
    return failed(reason.what(), not_comparable);
  } catch (const Interrupted&) {
    return failed("interrupted", interrupted_exit);
  } catch (const FileError& error) {
    // Files larger than the user permits (ulimit -f) are the user's mistake.
    const bool too_large =
        std::string(error.what()).find(std::strerror(EFBIG)) != std::string::npos;
    return failed(error.what(), too_large ? usage_error : internal_error);
  } catch (const std::exception& error) {
    return failed(std::string("internal error: ") + error.what(), internal_error);
  }
}

// An exit code if nothing is left to do: help was printed, or an error was reported.
std::optional<int> parse(CLI::App& program, const Words& words) {
  const auto refused = [&program](const std::string& why) {
    const CLI::App* command = command_of(program);
    return failed(
        why + " (see bench " + (command == &program ? "" : command->get_name() + " ") + "--help)",
        usage_error);
  };
  try {
    program.parse(Words(words.rbegin(), words.rend()));  // as CLI11 takes them
  } catch (const CLI::ExtrasError&) {
    return refused(not_understood(program, words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refused(error.what());
    const bool no_verb = !words.front().starts_with('-') && program.get_subcommands().empty();
    if (no_verb) return refused(not_understood(program, words));  // help for an unknown command
    return program.exit(error);                                   // --help, --version
  }
  return std::nullopt;
}

int run(int argc, char** argv) {
  CLI::App program(description, "bench");
  program.set_version_flag("-V,--version", version_text);
  program.require_subcommand(0, 1);  // "answers" in `list answers` is not a verb
  std::map<const CLI::App*, std::pair<Action, bool>> actions;  // and Verb::has_children
  Words plugins;
  for (const Verb& verb : verbs()) {
    CLI::App* app = actions.empty() ? &program : program.add_subcommand(verb.name, verb.summary);
    actions[app] = {verb.add(Command(app)), verb.has_children};
    app->add_option_function<Words>(
           "--plugin",
           [&plugins](const Words& files) {
             plugins.insert(plugins.end(), files.begin(), files.end());
           },
           "load solvers of your own: a shared library, a .py file or cmd:PROGRAM; repeatable")
        ->allow_extra_args(false)
        ->type_name("FILE");
  }
  if (const auto done = parse(program, usual_words(argc, argv))) return *done;
  catch_interrupts();
  const auto& [action, has_children] = actions.at(command_of(program));
  const auto act = [&, &run_verb = action] {
    return guarded([&] {
      load(plugins);
      return run_verb(recorded_words(argc, argv));
    });
  };
  return has_children ? act() : supervised(act);
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

void Command::option(const std::string& name, Place place, const std::string& help,
                     const std::string& type, const Bounds& bounds) const {
  std::visit(
      [&](auto value) {
        using Value = typename decltype(value)::type;
        CLI::Option* option =
            placed(app_->add_option(name == "--out" ? "-o,--out" : name, value.get(), help));
        option->type_name(type);
        if constexpr (std::is_same_v<Value, Numbers>)
          option->delimiter(',')->allow_extra_args(false);
        if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, Numbers>)
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
        return text;
      })
      ->delimiter('|')  // joins them again
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
  for (const CLI::Option* option : app_->get_options())
    if (option->get_group() == group_ && option->count() > 0) return option->get_name();
  return "";
}

}  // namespace harness

int main(int argc, char** argv) {
  harness::open_standard_streams();
  harness::use_one_thread(argv);
  return harness::guarded([&] { return harness::run(argc, argv); });
}
