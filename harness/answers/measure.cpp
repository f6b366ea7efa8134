#include "harness/answers/measure.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <utility>

#include "harness/base/child_process.h"
#include "harness/base/clock.h"
#include "harness/base/errors.h"
#include "harness/base/fields_json.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/points/schema.h"
#include "harness/run/calibration.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::Backend;
using inextensible::State;

// An answer's scene, built.
struct Built {
  explicit Built(const KnownAnswer& answer)
      : scene(make(answer)),
        at{*find_scene(answer.scene), complete_parameters(*find_scene(answer.scene), answer.given),
           scene} {}
  Built(const Built&) = delete;
  Built& operator=(const Built&) = delete;

  static Scene make(const KnownAnswer& answer) {
    const auto found_type = find_scene(answer.scene);
    const SceneType& type = *found_type;
    return type.build(complete_parameters(type, answer.given));
  }

  Scene scene;
  AnswerScene at;
};

// One run, and how it ended.
struct Ending {
  PointStatus status = PointStatus::ok;
  double strain = 0;  // the largest
  double seconds = 0;
  double value = unknown;
  std::string detail;
};

Ending run_once(const KnownAnswer& answer, const Built& built, const Backend& backend,
                const inextensible::Settings& settings, double step, double timeout) {
  Ending ending;
  const auto begin = Clock::now();
  const Scene& scene = built.scene;
  State state = start_of(scene, backend, step), before = state;
  const auto stepper = inextensible::make_stepper(backend.name, scene.problem,
                                                  {answer.strain_limit, 1, settings, &state});
  const auto reading = answer.reading(built.at);
  stepper->observe(reading->observer());
  const auto look = [&](const State& after, const DriveState& /*driven*/) {
    reading->after(before, after, step);
    before = after;
    raise(ending.strain, strain_range(*scene.problem, stepper->filtered_positions()).most);
    if (backend.strain_control == inextensible::StrainControl::stiffness &&
        !(ending.strain <= Calibration::cut_short * answer.strain_limit)) {
      ending.status = PointStatus::strain_missed;
      ending.detail = "strain " + number_text(ending.strain, 3);
    }
    return ending.status == PointStatus::ok && !reading->done();
  };
  const DriveState driven =
      drive(*stepper, state, {step, std::lround(scene.duration / step)}, look, {timeout, begin});
  stepper->observe(nullptr);
  ending.seconds = since(begin);
  if (driven.end == DriveState::End::refused) {
    ending.status = PointStatus::not_converged;
    ending.detail = "refused at t = " + number_text(state.time, 3) + " s: " + driven.result.detail;
  } else if (driven.end == DriveState::End::timed_out) {
    ending.status = PointStatus::timeout;
    ending.detail = "longer than " + number_text(timeout) + " s";
  }
  if (ending.status == PointStatus::ok) {
    ending.value = reading->value();
    if (!std::isfinite(ending.value)) ending.detail = "the run does not tell";
  }
  return ending;
}

Ending run_calibrated(const KnownAnswer& answer, const Backend& backend, double step,
                      double timeout) {
  const Built built(answer);
  if (backend.strain_control != inextensible::StrainControl::stiffness)
    return run_once(answer, built, backend, {}, step, timeout);
  Ending best;
  best.status = PointStatus::skipped;
  std::map<double, Ending> endings;
  Calibration calibration(answer.strain_limit, [&](double stiffness) -> Calibration::Trial {
    const Ending& e = endings[stiffness] =
        run_once(answer, built, backend, {{"stiffness", stiffness}}, step, timeout);
    return {e.status, e.strain, e.seconds, e.detail};
  });
  const auto found = calibration.find(first_stiffness(built.scene, answer.strain_limit));
  if (found) return endings.at(*found);
  best.detail = calibration.detail();
  return best;
}

// The order of accuracy that deviations show, from step to step of half the size.
class Order {
 public:
  // continuum: against what small steps lead to, from three steps, instead of the exact value.
  // strain_limit: what it permits is no error of the method, below a few times of it there is no
  // order to be seen.
  Order(bool continuum, double strain_limit) : continuum_(continuum), least_(10 * strain_limit) {}

  double next(double deviation) {
    const double error = continuum_ ? deviation - std::exchange(last_, deviation) : deviation;
    const double coarser = std::exchange(error_, error);
    return std::abs(error) > least_ ? std::log2(std::abs(coarser / error)) : unknown;
  }

 private:
  bool continuum_;
  double least_;
  double last_ = unknown, error_ = unknown;
};

nlohmann::json to_json(const Ending& ending) {
  return {{"value", number(ending.value)}, {"detail", ending.detail}};
}

Ending ending_of(const nlohmann::json& object) {
  Ending ending;
  ending.value = number_of(object.at("value"));
  ending.detail = object.at("detail");
  return ending;
}

// Throws Interrupted.
Ending run_apart(const KnownAnswer& answer, const Backend& backend, double step, double timeout,
                 const std::function<bool()>& interrupted) {
  // Springs need several runs to find their stiffness.
  const double all_runs = timeout * (Calibration::run_limit + 2);
  ChildOutcome child = run_in_child(
      [&](Heartbeat& heartbeat) {
        heartbeat.restart();
        return compact(to_json(run_calibrated(answer, backend, step, timeout)));
      },
      {all_runs, 0, interrupted});
  if (child.end == ChildOutcome::End::interrupted) throw Interrupted();
  if (const auto ending = harness::answer(child, ending_of)) return *ending;
  Ending lost;
  lost.detail = child.end == ChildOutcome::End::timed_out ? "a step did not end" : ending(child);
  return lost;
}

}  // namespace

std::vector<AnswerRun> plan_answers(const AnswerSelection& selection) {
  std::vector<AnswerRun> plan;
  for (const KnownAnswer& answer : known_answers()) {
    if (selection.answer && !selection.answer->matches(answer.name)) continue;
    const Scene scene = Built::make(answer);
    for (const Backend& backend : inextensible::backends()) {
      if (!backend.contestant || (selection.solver && !matches(*selection.solver, backend.name)))
        continue;
      if (answer.needs_multipliers && !backend.shows_iterates) continue;
      if (inextensible::part_not_taken(backend, *scene.problem)) continue;
      plan.push_back({&answer, backend.name});
    }
  }
  if (plan.empty())
    throw UsageError("no known answer and contestant match (bench list answers, solvers)");
  return plan;
}

double exact_value(const KnownAnswer& answer) { return answer.exact(Built(answer).at); }

namespace {

// Throws Interrupted, with the rows so far.
void run_rows(const std::vector<AnswerRun>& plan, double timeout, const AnswerEvents& events,
              std::vector<AnswerRow>& rows) {
  std::size_t all = 0;
  for (const AnswerRun& run : plan) all += run.answer->steps.size();
  for (const AnswerRun& run : plan) {
    const double exact = exact_value(*run.answer);
    Order order(run.answer->continuum, run.answer->strain_limit);
    for (const double step : run.answer->steps) {
      if (events.interrupted()) throw Interrupted();
      const std::string key =
          std::string(run.answer->name) + "/" + run.solver + "/" + step_text(step);
      const Ending ending = ending_of(events.once(key, [&] {
        return to_json(run_apart(*run.answer, *inextensible::find_backend(run.solver), step,
                                 timeout, events.interrupted));
      }));
      AnswerRow row;
      row.answer = run.answer->name;
      row.solver = run.solver;
      row.step = step;
      row.value = ending.value;
      row.deviation = exact == 0 ? row.value : row.value / exact - 1;
      row.order = order.next(row.deviation);
      row.detail = ending.detail;
      rows.push_back(row);
      events.row(row, rows.size(), all);
    }
  }
}

}  // namespace

AnswerOutcome run_answers(const std::vector<AnswerRun>& plan, double timeout,
                          const AnswerEvents& events) {
  AnswerOutcome outcome;
  try {
    run_rows(plan, timeout, events, outcome.rows);
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  return outcome;
}

namespace {

// "" where it is null.
std::string text_in(const nlohmann::json& object, const char* key) {
  const nlohmann::json& value = object.at(key);
  return value.is_string() ? value.get<std::string>() : "";
}

}  // namespace

nlohmann::json answers_document(nlohmann::json context, const std::vector<AnswerRun>& plan,
                                const AnswerOutcome& outcome,
                                const std::vector<std::string>& command) {
  context["command"] = command;
  nlohmann::json answers = nlohmann::json::array(), rows = nlohmann::json::array();
  const KnownAnswer* last = nullptr;
  for (const AnswerRun& run : plan) {
    if (run.answer == std::exchange(last, run.answer)) continue;
    const KnownAnswer& answer = *run.answer;
    answers.push_back({{"name", answer.name},
                       {"scene", answer.scene},
                       {"scene_parameters", Built(answer).at.parameters},
                       {"quantity", answer.quantity},
                       {"source", answer.source},
                       {"strain_limit", answer.strain_limit},
                       {"exact", exact_value(answer)},
                       {"continuum", answer.continuum}});
  }
  for (const AnswerRow& row : outcome.rows) {
    nlohmann::json object;
    write_fields(object, answer_row_fields, row);
    rows.push_back(std::move(object));
  }
  return {{"schema", "inextensible-answers/1"}, {"complete", outcome.complete},
          {"context", std::move(context)},      {"legend", legend()},
          {"answers", std::move(answers)},      {"rows", std::move(rows)}};
}

void print_answers(std::ostream& out, const nlohmann::json& document) {
  const nlohmann::json& rows = document.at("rows");
  for (const nlohmann::json& answer : document.at("answers")) {
    out << '\n'
        << text_in(answer, "name") << " (" << text_in(answer, "scene")
        << "): " << text_in(answer, "quantity") << "\n  exact "
        << number_text(answer.at("exact").get<double>(), 6) << ", " << text_in(answer, "source")
        << '\n';
    for (const nlohmann::json& row : rows) {
      if (row.at("answer") != answer.at("name")) continue;
      out << "  " << std::left << std::setw(32) << text_in(row, "solver") << "h = " << std::setw(12)
          << row.at("step").get<double>();
      if (row.at("value").is_number()) {
        out << std::setw(14) << number_text(row.at("value").get<double>(), 6);
        if (row.at("order").is_number())
          out << "order " << number_text(row.at("order").get<double>(), 2);
      } else {
        out << text_in(row, "detail");
      }
      out << '\n';
    }
  }
}

}  // namespace harness
