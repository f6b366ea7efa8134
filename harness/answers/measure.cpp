#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <numeric>
#include <utility>

#include "harness/answers/answer.h"
#include "harness/base/clock.h"
#include "harness/base/errors.h"
#include "harness/base/fields.h"
#include "harness/base/small_runs.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/points/schema.h"
#include "harness/run/calibration.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::Backend;
using inextensible::State;

struct Ending : CalibrationTrial {
  double value = unknown;
};

AnswerScene scene_of(const KnownAnswer& answer) { return answer_scene(answer.scene, answer.given); }

// Keeps what the last multipliers pull: lambda_k times the gradient of edge k's constraint.
class PullObserver final : public inextensible::IterateObserver {
 public:
  PullObserver(const inextensible::Problem& problem, std::vector<double>& pulls)
      : gradient_(3, problem.constraints()), pulls_(pulls) {}

  void iterate(const inextensible::EdgeConstraints& edges, int /*j*/,
               const inextensible::Positions& x, const Eigen::VectorXd& multipliers) override {
    edges.gradient(x, gradient_);
    pulls_.assign(static_cast<std::size_t>(gradient_.cols()), 0);
    for (int k = 0; k < edges.count(); ++k)
      pulls_[static_cast<std::size_t>(edges.problem_edge(k))] =
          multipliers(k) * gradient_.col(k).norm();
  }

 private:
  Eigen::Matrix3Xd gradient_;
  std::vector<double>& pulls_;
};

Ending run_once(const KnownAnswer& answer, const AnswerScene& at, const Backend& backend,
                const inextensible::Settings& settings, double step, double timeout) {
  Ending ending;
  const auto begin = Clock::now();
  const Scene& scene = at.scene;
  State state = start_of(scene, backend, step);
  const auto stepper = inextensible::make_stepper(backend.name, scene.problem,
                                                  {answer.strain_limit, 1, settings, &state});
  Motion motion(state, step);
  PullObserver pulls(*scene.problem, motion.pulls);
  if (answer.needs_multipliers) stepper->observe(&pulls);
  const auto look = [&](const State& after, const DriveState& /*driven*/) {
    motion.take(after);
    raise(ending.strain, strain_range(*scene.problem, stepper->filtered_positions()).most);
    if (backend.strain_control == inextensible::StrainControl::stiffness &&
        !(ending.strain <= calibration_cut_short * answer.strain_limit)) {
      ending.status = PointStatus::strain_missed;
      ending.detail = "strain " + number_text(ending.strain, 3);
    }
    return ending.status == PointStatus::ok &&
           !(answer.until_read && std::isfinite(answer.reading(at, motion)));
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
    ending.value = answer.reading(at, motion);
    if (!std::isfinite(ending.value)) ending.detail = "the run does not tell";
  }
  return ending;
}

Ending run_calibrated(const KnownAnswer& answer, const Backend& backend, double step,
                      double timeout) {
  const AnswerScene at = scene_of(answer);
  if (backend.strain_control != inextensible::StrainControl::stiffness)
    return run_once(answer, at, backend, {}, step, timeout);
  std::map<double, Ending> endings;
  const Calibration found = calibrate_stiffness(
      answer.strain_limit, first_stiffness(at.scene, answer.strain_limit), [&](double stiffness) {
        return endings[stiffness] =
                   run_once(answer, at, backend, {{"stiffness", stiffness}}, step, timeout);
      });
  if (found.stiffness) return endings.at(*found.stiffness);
  return {{.detail = found.detail}};
}

// The order of accuracy that the last deviations show, from step to step of half the size: of a
// continuum against what small steps lead to, from three steps, instead of the exact value. What
// the strain limit permits is no error of the method: below a few times of it no order shows.
double order_of(const KnownAnswer& answer, std::vector<double> deviations) {
  if (answer.continuum)
    std::adjacent_difference(deviations.begin(), deviations.end(), deviations.begin());
  const std::size_t n = deviations.size();
  if (n < (answer.continuum ? 3 : 2)) return unknown;
  const double coarse = deviations[n - 2], fine = deviations[n - 1];
  return std::abs(fine) > 10 * answer.strain_limit ? std::log2(std::abs(coarse / fine)) : unknown;
}

// The value, and why there is none. Throws Interrupted.
nlohmann::json run_apart(const KnownAnswer& answer, const Backend& backend, double step,
                         double timeout, const std::function<bool()>& interrupted) {
  const auto json_of = [](double value, const std::string& detail) {
    return nlohmann::json{{"value", number(value)}, {"detail", detail}};
  };
  // Springs need several runs to find their stiffness.
  const double all_runs = timeout * (calibration_run_limit + 2);
  return in_child(
      {all_runs, 0, interrupted},
      [&](Heartbeat& heartbeat) {
        heartbeat.restart();
        const Ending ending = run_calibrated(answer, backend, step, timeout);
        return json_of(ending.value, ending.detail);
      },
      [](const nlohmann::json& run) { return run; },
      [&](const ChildOutcome& child) {
        const bool stuck = child.end == ChildOutcome::End::timed_out;
        return json_of(unknown, stuck ? "a step did not end" : ending(child));
      });
}

}  // namespace

std::vector<AnswerRun> plan_answers(const AnswerSelection& selection) {
  std::vector<AnswerRun> plan;
  for (const KnownAnswer& answer : known_answers()) {
    if (selection.answer && !selection.answer->matches(answer.name)) continue;
    const AnswerScene at = scene_of(answer);
    for (const Backend& backend : inextensible::backends()) {
      if (!backend.contestant || (selection.solver && !matches(*selection.solver, backend.name)))
        continue;
      if (answer.needs_multipliers && !backend.shows_iterates) continue;
      if (inextensible::part_not_taken(backend, *at.scene.problem)) continue;
      plan.push_back({&answer, backend.name});
    }
  }
  if (plan.empty())
    throw UsageError("no known answer and contestant match (bench list answers, solvers)");
  return plan;
}

AnswerOutcome run_answers(const std::vector<AnswerRun>& plan, double timeout,
                          const RunEvents& events) try {
  AnswerOutcome outcome;
  std::size_t all = 0;
  for (const AnswerRun& run : plan) all += run.answer->steps.size();
  for (const AnswerRun& run : plan) {
    const double exact = run.answer->exact(scene_of(*run.answer));
    std::vector<double> deviations;
    for (const double step : run.answer->steps) {
      if (events.interrupted()) throw Interrupted();
      const std::string name = run.answer->name + "/" + run.solver;
      const nlohmann::json found = events.once(name + "/" + step_text(step), [&] {
        return run_apart(*run.answer, *inextensible::find_backend(run.solver), step, timeout,
                         events.interrupted);
      });
      const double value = number_of(found.at("value"));
      deviations.push_back(exact == 0 ? value : value / exact - 1);
      outcome.rows.push_back({run.answer->name, run.solver, step, value, deviations.back(),
                              order_of(*run.answer, deviations), found.at("detail")});
      events.done(name, outcome.rows.size(), all);
    }
  }
  return outcome;
} catch (const Interrupted&) {
  return {{}, false};
}

nlohmann::json answers_document(nlohmann::json context, const std::vector<AnswerRun>& plan,
                                const AnswerOutcome& outcome,
                                const std::vector<std::string>& command) {
  context["command"] = command;
  nlohmann::json answers = nlohmann::json::array(), rows = nlohmann::json::array();
  const KnownAnswer* last = nullptr;
  for (const AnswerRun& run : plan) {
    if (run.answer == std::exchange(last, run.answer)) continue;
    const KnownAnswer& answer = *run.answer;
    const AnswerScene at = scene_of(answer);
    answers.push_back({{"name", answer.name},
                       {"scene", answer.scene},
                       {"scene_parameters", at.parameters},
                       {"quantity", answer.quantity},
                       {"source", answer.source},
                       {"strain_limit", answer.strain_limit},
                       {"exact", answer.exact(at)},
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
  const auto text_in = [](const nlohmann::json& object, const char* key) {
    const nlohmann::json& value = object.at(key);
    return value.is_string() ? value.get<std::string>() : "";
  };
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
