// bench man, bench completion: written from the options themselves.
#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"

namespace harness {
namespace {

// Characters that mean something to roff.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) {
      escaped += std::string("\\&") + c;
    } else {
      escaped += c;
    }
  }
  return escaped;
}

void describe_options(const CLI::App& app, std::string& page) {
  for (const CLI::Option* option : app.get_options()) {
    std::string name = option->get_name(true, true);  // "-h,--help", or a word in its place
    for (std::size_t at = 0; (at = name.find(',', at)) != std::string::npos; at += 2)
      name.replace(at, 1, ", ");
    const std::string type = option->get_type_name();
    page += ".TP\n.B " +
            roff(name + (type.empty() || option->get_items_expected_max() == 0 ? "" : " " + type)) +
            "\n" + roff(option->get_description()) + "\n";
  }
}

std::string option_names(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      names += (names.empty() ? "--" : " --") + name;
  }
  return names;
}

}  // namespace

const CLI::App& Command::program() const {
  const CLI::App* app = app_;
  while (app->get_parent()) app = app->get_parent();
  return *app;
}

std::string Command::manual() const {
  const CLI::App& bench = program();
  const std::string text = bench.get_description();
  const std::size_t end = text.find('\n');
  std::string first = text.substr(0, end);
  if (first.starts_with("bench: ")) first = first.substr(7);
  std::string page = ".TH BENCH 1\n.SH NAME\nbench \\- " + roff(first) +
                     "\n.SH SYNOPSIS\n.B bench\n[\\fICOMMAND\\fR] [\\fIOPTION\\fR ...]\n"
                     ".SH DESCRIPTION\n.nf\n" +
                     roff(end == std::string::npos ? "" : text.substr(end + 1)) +
                     ".fi\n.SH OPTIONS\n";
  describe_options(bench, page);
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : bench.get_subcommands([](const CLI::App*) { return true; })) {
    page += ".SS " + roff(command->get_name()) + "\n" + roff(command->get_description()) + "\n";
    describe_options(*command, page);
  }
  return page;
}

std::string Command::bash_completion() const {
  const CLI::App& bench = program();
  std::string verbs, cases;
  for (const CLI::App* command : bench.get_subcommands([](const CLI::App*) { return true; })) {
    verbs += " " + command->get_name();
    cases += "    " + command->get_name() + ") words='" + option_names(*command) + "' ;;\n";
  }
  return "# Completion for Bash: source <(bench completion)\n_bench() {\n"
         "  local words verb=${COMP_WORDS[1]-} word=${COMP_WORDS[COMP_CWORD]}\n"
         "  local bench=${COMP_WORDS[0]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  case $previous in\n"
         "    --solver) words=$(\"$bench\" list solvers 2>/dev/null | sed -n 's/^  "
         "\\([a-z0-9_]*\\): .*/\\1/p') ;;\n"
         "    --scene) words=$(\"$bench\" list scenes 2>/dev/null | sed -n 's/^  \\([a-z0-9_]*\\): "
         ".*/\\1/p') ;;\n"
         "    --profile) words=$(\"$bench\" list suites 2>/dev/null | sed -n 's/^  "
         "\\([a-z0-9_]*\\): .*/\\1/p') ;;\n"
         "    --sweep | sweep) words='strain resolution step stability' ;;\n"
         "    --steps) words='search all adaptive' ;;\n"
         "    help) words='" +
         verbs +
         "' ;;\n"
         "    *)\n  case $verb in\n" +
         cases + "    *) words='" + option_names(bench) + " help sweep" + verbs +
         "' ;;\n  esac ;;\n  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
         "  ((${#COMPREPLY[@]})) || mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
         "}\ncomplete -o filenames -F _bench bench ./bench\n";
}

Verb man_verb() {
  return {"man", "print the manual page: bench man | man -l -",
          [](const Command& command) -> Action {
            return [command] {
              std::cout << command.manual();
              return success;
            };
          }};
}

Verb completion_verb() {
  return {"completion", "print completion for Bash: source <(bench completion)",
          [](const Command& command) -> Action {
            return [command] {
              std::cout << command.bash_completion();
              return success;
            };
          }};
}

}  // namespace harness
