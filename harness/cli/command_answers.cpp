// bench answers: what solvers make of figures that theory knows.
#include <sstream>

#include "harness/answers/answer.h"
#include "harness/cli/command.h"
#include "harness/points/context.h"

namespace harness {
namespace {

struct Answers : OutputOptions {
  std::string solver, answer;
  double timeout = 20;

  void declare(const Command& command) {
    add_solver(command, solver);
    command.alternatives("--answer", answer,
                         "only answers whose whole name matches (bench list answers)");
    add_timeout(command, timeout, "20");
    OutputOptions::declare(command, "answers.json");
  }

  int run(const Words& typed) {
    const auto plan = plan_answers({pattern_of("--answer", answer), solver_pattern(solver)});
    nlohmann::json context = machine_context();
    context["selection"] = {{"solver", solver}, {"answer", answer}, {"timeout", timeout}};
    const auto compute = [&](const std::string&, Journal& journal,
                             const nlohmann::json&) -> Finished {
      Progress progress;
      const AnswerOutcome outcome = run_answers(plan, timeout, journaled_events(journal, progress));
      if (!outcome.complete) return {.complete = false};
      nlohmann::json document = answers_document(context, plan, outcome, typed);
      std::ostringstream text;
      print_answers(text, document);
      return {std::move(document), true, text.str()};
    };
    return carry_out(*this, {"answers", context, {}, "rows", "runs", compute});
  }
};

}  // namespace

Action answers_verb(const Command& command) { return verb<Answers>(command); }

}  // namespace harness
