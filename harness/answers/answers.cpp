// The known answers of configs/answers.json, and what solvers make of them.
#include "harness/answers/answer.h"
#include "harness/base/child_process.h"
#include "harness/base/table.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/run/calibration.h"
#include "harness/scenes/meshes.h"
#include "solvers/problem/edge_constraints.h"

namespace harness {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(KnownAnswer, name, scene, given, quantity, source,
                                                strain_limit, needs_multipliers, continuum,
                                                until_read, stiffness)

namespace {

const std::map<std::string, double (*)(const SceneParameters&)> formulas{
    {"hanging_frequency",
     [](const SceneParameters& at) {
       return hanging_frequency(static_cast<int>(at.at("n")) - 1, row_link(at), at.at("gravity"),
                                static_cast<int>(at.at("mode")));
     }},
    {"folded_fall_time",
     [](const SceneParameters& at) {
       return folded_fall_time(folded_part, at.at("length"), at.at("gravity"));
     }},
    {"folded_speed", [](const SceneParameters&) { return 1 / std::sqrt(1 - folded_part); }}};

struct Ending : CalibrationTrial {
  double value = unknown;
};

// Keeps the pulls of the last multipliers: lambda_k times the gradient of edge k's constraint.
class PullObserver final : public inextensible::IterateObserver {
 public:
  PullObserver(const Problem& problem, std::vector<double>& pulls)
      : gradient_(3, problem.constraints()), pulls_(pulls) {}

  void iterate(const inextensible::EdgeConstraints& edges, int /*j*/, const Positions& x,
               const Eigen::VectorXd& multipliers) override {
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
                const Settings& settings, double step, double timeout) {
  Ending ending;
  const auto begin = Clock::now();
  const Scene& scene = at.scene;
  State state = start_of(scene, backend, step);
  const auto stepper =
      make_stepper(backend.name, scene.problem, {answer.strain_limit, 1, settings, &state});
  Motion motion(state, step);
  PullObserver pulls(*scene.problem, motion.pulls);
  if (answer.needs_multipliers) stepper->observe(&pulls);
  const auto look = [&](const State& after, const DriveState& /*driven*/) {
    motion.take(after);
    raise(ending.strain, strain_range(*scene.problem, stepper->filtered_positions()).most);
    if (backend.strain_control == StrainControl::stiffness && std::isnan(answer.stiffness) &&
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
    if (!std::isfinite(ending.value)) ending.detail = "the run does not show it";
  }
  return ending;
}

Ending run_calibrated(const KnownAnswer& answer, const Backend& backend, double step,
                      double timeout) {
  const AnswerScene at = answer.at();
  const auto run = [&](const Settings& settings) {
    return run_once(answer, at, backend, settings, step, timeout);
  };
  if (backend.strain_control != StrainControl::stiffness) return run({});
  if (std::isfinite(answer.stiffness)) return run({{"stiffness", answer.stiffness}});
  std::map<double, Ending> endings;
  const Calibration found = calibrate_stiffness(
      answer.strain_limit, first_stiffness(at.scene, answer.strain_limit), [&](double stiffness) {
        return endings[stiffness] = run({{"stiffness", stiffness}});
      });
  if (found.stiffness) return endings.at(*found.stiffness);
  return {{.detail = found.detail}};
}

// The order of accuracy from the last two deviations, at a step and its half. Runs of a continuum
// do not tend to the exact value: differences between deviations at three steps take their place.
// What the strain limit permits is not an error of the method: close to it no order can be seen.
double order_of(const KnownAnswer& answer, std::vector<double> deviations) {
  if (answer.continuum)
    std::adjacent_difference(deviations.begin(), deviations.end(), deviations.begin());
  const std::size_t n = deviations.size();
  if (n < (answer.continuum ? 3 : 2)) return unknown;
  const double coarse = deviations[n - 2], fine = deviations[n - 1];
  return std::abs(fine) > 10 * answer.strain_limit ? std::log2(std::abs(coarse / fine)) : unknown;
}

// The value, or why there is none. Throws Interrupted.
json run_apart(const KnownAnswer& answer, const Backend& backend, double step, double timeout,
               const std::function<bool()>& interrupted) {
  // Springs need several runs to find their stiffness.
  const double all_runs = timeout * (calibration_run_limit + 2);
  return in_child(
      {all_runs, 0, interrupted},
      [&](Heartbeat& heartbeat) -> json {
        heartbeat.restart();
        const Ending ending = run_calibrated(answer, backend, step, timeout);
        return {{"value", number(ending.value)}, {"detail", ending.detail}};
      },
      [](const json& run) { return run; },
      [](const ChildOutcome& child) -> json {
        return {{"value", nullptr}, {"detail", ending(child)}};
      });
}

}  // namespace

AnswerScene answer_scene(std::string_view name, const SceneParameters& given) {
  const auto type = find_scene(name);
  const SceneParameters parameters = complete_parameters(*type, given);
  return {type, parameters, type->build(parameters)};
}

std::span<const KnownAnswer> known_answers() {
  static const std::vector<KnownAnswer> table = [] {
    const std::string path = source_path("configs/answers.json");
    std::vector<KnownAnswer> all;
    for (const json& entry : parse_document(read_file(path, "file of known answers"), path)) {
      KnownAnswer answer = entry;
      answer.reading = reading_named(entry.at("reading"));
      for (int i = 0; i < entry.at("steps").get<int>(); ++i)
        answer.steps.push_back(std::ldexp(entry.at("first_step").get<double>(), -i));
      if (const json& exact = entry.at("exact"); exact.is_string())
        answer.exact =
            formulas.at(exact)(complete_parameters(*find_scene(answer.scene), answer.given));
      else
        answer.exact = exact;
      all.push_back(std::move(answer));
    }
    return all;
  }();
  return table;
}

std::vector<AnswerRun> plan_answers(const std::optional<Pattern>& answer_pattern,
                                    const std::optional<Pattern>& solver) {
  std::vector<AnswerRun> plan;
  for (const KnownAnswer& answer : known_answers()) {
    if (answer_pattern && !answer_pattern->matches(answer.name)) continue;
    const AnswerScene at = answer.at();
    for (const Backend& backend : backends()) {
      if (!backend.contestant || (solver && !matches(*solver, backend.name))) continue;
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
    const double exact = run.answer->exact;
    std::vector<double> deviations;
    for (const double step : run.answer->steps) {
      if (events.interrupted()) throw Interrupted();
      const std::string name = run.answer->name + "/" + run.solver;
      const json found = events.once(name + "/" + step_text(step), [&] {
        return run_apart(*run.answer, *find_backend(run.solver), step, timeout, events.interrupted);
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

json answers_document(json context, const std::vector<AnswerRun>& plan,
                      const AnswerOutcome& outcome, const std::vector<std::string>& command) {
  context["command"] = command;
  json answers = json::array(), rows = json::array();
  const KnownAnswer* last = nullptr;
  for (const AnswerRun& run : plan) {
    if (run.answer == std::exchange(last, run.answer)) continue;
    const KnownAnswer& answer = *run.answer;
    answers.push_back({{"name", answer.name},
                       {"scene", answer.scene},
                       {"scene_parameters", answer.at().parameters},
                       {"quantity", answer.quantity},
                       {"source", answer.source},
                       {"strain_limit", answer.strain_limit},
                       {"exact", answer.exact},
                       {"continuum", answer.continuum}});
  }
  for (const AnswerRow& row : outcome.rows) {
    json object;
    write_fields(object, answer_row_fields, row);
    rows.push_back(std::move(object));
  }
  return {{"schema", "inextensible-answers/1"}, {"complete", outcome.complete},
          {"context", std::move(context)},      {"legend", legend()},
          {"answers", std::move(answers)},      {"rows", std::move(rows)}};
}

void print_answers(std::ostream& out, const json& document) {
  for (const json& answer : document.at("answers")) {
    const auto word = [&answer](const char* key) { return answer.at(key).get<std::string>(); };
    out << '\n'
        << word("name") << " (" << word("scene") << "): " << word("quantity") << "\n  exact "
        << number_text(answer.at("exact")) << ", " << word("source") << '\n';
    Table table{{}};
    for (const json& object : document.at("rows")) {
      AnswerRow row;
      read_fields(object, answer_row_fields, row);
      if (row.answer != word("name")) continue;
      auto& cells = table.rows.emplace_back();
      cells = {"  " + row.solver, "h = " + number_text(row.step)};
      if (!std::isnan(row.value)) {
        cells.push_back(number_text(row.value));
        cells.push_back(std::isnan(row.order) ? "" : "order " + number_text(row.order, 2));
      } else if (!row.detail.empty()) {
        cells.push_back(row.detail);
      }
    }
    print_aligned(out, table);
  }
}

}  // namespace harness
