// bench answers: what solvers make of figures that theory knows.
#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "harness/answers/measure.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/cli/commands.h"
#include "harness/cli/sweep_command.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

struct AnswersOptions {
  SweepCommand output;  // --out, --force, --solver, --no-plots
  std::string answer;
  double timeout = 20;
};

int answers(const AnswersOptions& given, const std::vector<std::string>& command) {
  AnswerSelection selection;
  selection.timeout = given.timeout;
  if (!given.output.solver.empty()) {
    check_solver_pattern(given.output.solver);
    selection.solver = Pattern("--solver", given.output.solver);
  }
  if (!given.answer.empty()) selection.answer = Pattern("--answer", given.answer);
  const auto plan = plan_answers(selection);
  const std::string out = chosen_output(given.output, "answers");
  if (!given.output.force && std::filesystem::exists(out))
    throw UsageError("'" + out +
                     "' is there already: --force replaces it, another --out keeps both");
  check_writable(out);
  catch_interrupts();
  AnswerEvents events;
  events.interrupted = interrupted;
  const bool terminal = isatty(STDERR_FILENO) == 1;
  events.row = [&](const AnswerRow& row, std::size_t done, std::size_t all) {
    if (terminal) {
      std::cerr << "\r\033[K[" << done << '/' << all << "] " << row.answer << '/' << row.solver
                << (done == all ? "\n" : "");
    } else if (done % 100 == 0 || done == all) {
      std::cerr << '[' << done << '/' << all << "]\n";
    }
  };
  const AnswerOutcome outcome = run_answers(plan, given.timeout, events);
  const nlohmann::json document = answers_document(machine_context(), plan, outcome, command);
  write_atomically(out, result_text(document));
  print_answers(std::cout, document);
  std::cout << "\nwritten:\n" << out << std::endl;
  if (!outcome.complete) return interrupted_exit;
  if (!given.output.no_plots && draw({out}) != 0)
    std::cerr << "bench: the figure could not be drawn\n";
  return success;
}

}  // namespace

void add_answers_command(const Command& program, const std::vector<std::string>& words) {
  const auto given = std::make_shared<AnswersOptions>();
  const Command command = program.subcommand(
      "answers", "figures that theory knows (orbits, oscillations, falls), by each solver");
  command.alternatives("--solver", given->output.solver, "these only, each by its whole name");
  command.option("--answer", given->answer, "these only: a regular expression for whole names",
                 "REGEX");
  command.option("--timeout", given->timeout, "longest run, s; springs need up to 16 runs", "S")
      .positive();
  command.option("--out", given->output.out, "result; default: results/local/answers.json", "FILE");
  command.flag("--no-plots", given->output.no_plots, "do not draw the figure");
  command.flag("--force", given->output.force, "even if there is a result already");
  command.does([given, words] { return answers(*given, words); });
}

}  // namespace harness
