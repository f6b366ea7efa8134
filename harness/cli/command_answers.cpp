// bench answers: what solvers make of figures that theory knows.
#include <iostream>

#include "harness/answers/measure.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/figures.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/sweep_output.h"
#include "harness/cli/verbs.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;

struct AnswersOptions : OutputOptions {
  std::string solver, answer;
  double timeout = 20;
  bool no_plots = false;
};

int answers(const AnswersOptions& given, const std::vector<std::string>& command) {
  AnswerSelection selection;
  selection.timeout = given.timeout;
  if (!given.solver.empty()) {
    check_solver_pattern(given.solver);
    selection.solver = Pattern("--solver", given.solver);
  }
  if (!given.answer.empty()) selection.answer = Pattern("--answer", given.answer);
  const auto plan = plan_answers(selection);
  const std::string out = chosen_output(given, "answers");
  check_writable(out);
  json context = machine_context();
  context["selection"] = {
      {"solver", given.solver}, {"answer", given.answer}, {"timeout", given.timeout}};
  Journal journal(out);
  if (begin_journal(given, out, journal,
                    {identity(context, {}, context["selection"]), context, "rows", "runs"})
          .finished) {
    std::cout << out << " is complete already\n";
    return success;
  }
  catch_interrupts();
  const AnswerOutcome outcome = run_answers(plan, given.timeout, journaled_events(journal));
  if (!outcome.complete) return tell_interrupted();
  const json document = answers_document(context, plan, outcome, command);
  write_atomically(out, result_text(document));
  print_answers(std::cout, document);
  std::cout << "\nwritten:\n" << out << std::endl;
  journal.remove();
  if (!given.no_plots && draw_result(out) != 0)
    std::cerr << "bench: the figure could not be drawn\n";
  return success;
}

}  // namespace

Verb answers_verb() {
  return {"answers", "compare each solver with exact answers (orbits, oscillations, falls)",
          [](const Command& command) -> Action {
            const auto given = std::make_shared<AnswersOptions>();
            add_solver(command, given->solver);
            command.alternatives("--answer", given->answer,
                                 "only answers whose whole name matches (bench list answers)");
            add_timeout(command, given->timeout, "20");
            command.option("--out", given->out, "result file; default: results/local/answers.json",
                           "FILE");
            add_no_plots(command, given->no_plots);
            add_output_rules(command, *given);
            return [given, command] { return answers(*given, command.words()); };
          }};
}

}  // namespace harness
