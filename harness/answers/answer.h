// Figures that theory knows of a scene: what a run makes of them, and what they should be.
#pragma once

#include <ostream>

#include "harness/base/journal.h"
#include "harness/points/schema.h"

namespace harness {

struct AnswerScene {
  std::shared_ptr<const SceneType> type;
  SceneParameters parameters;  // complete: the scene is built from these
  Scene scene;
};
AnswerScene answer_scene(std::string_view name, const SceneParameters& given);

struct Motion {
  Motion(const State& start, double h) : state(start), step(h) { take(start); }
  // After each accepted step.
  void take(const State& after) {
    before = std::exchange(state, after);
    times.push_back(after.time);
    free_end.emplace_back(after.x.rightCols<1>());
  }

  State state, before;                    // after and before the last step
  double step;                            // s
  std::vector<double> times;              // s, from the start on
  std::vector<Eigen::Vector3d> free_end;  // where the last vertex was at these
  std::vector<double> pulls;  // N s^2, by edge, of the last multipliers; empty if none were shown
};

// What is read off a run; NaN if the run does not show it.
using Reading = double(const AnswerScene& at, const Motion& motion);
Reading* reading_named(const std::string& name);  // throws std::out_of_range

// Part of the length that the free end of a folded chain has moved by when it is read. Closer to
// the end so few links still move that the chain no longer resembles a continuum.
constexpr double folded_part = 0.9;

struct KnownAnswer {
  std::string name;  // a-z and _
  std::string scene;
  SceneParameters given;           // the others have the scene's own values
  std::string quantity;            // what is read off, with its unit
  std::string source;              // formula, author, year
  double strain_limit = 0;         // of the runs
  bool needs_multipliers = false;  // only for methods that show their iterates (Stepper::observe)
  bool continuum = false;      // exact in the limit of many vertices: runs tend to something nearby
  bool until_read = false;     // a run ends as soon as it shows the quantity
  double stiffness = unknown;  // N, of methods without a limit; unknown: calibrated to keep it
  std::vector<double> steps;   // s, each half of the one before
  double exact = 0;
  Reading* reading = nullptr;

  AnswerScene at() const { return answer_scene(scene, given); }
};

std::span<const KnownAnswer> known_answers();

// A solver's runs at all steps of an answer, each in a child process, the coarsest step first.
struct AnswerRun {
  const KnownAnswer* answer;
  std::string solver;
};
// All contestants that can run the scene. Patterns match whole names. Throws UsageError if none do.
std::vector<AnswerRun> plan_answers(const std::optional<Pattern>& answer,
                                    const std::optional<Pattern>& solver);

struct AnswerOutcome {
  std::vector<AnswerRow> rows;
  bool complete = true;  // false: interrupted
};
// timeout: s of wall time, of each run.
AnswerOutcome run_answers(const std::vector<AnswerRun>& plan, double timeout,
                          const RunEvents& events);

json answers_document(json context, const std::vector<AnswerRun>& plan,
                      const AnswerOutcome& outcome, const std::vector<std::string>& command);
void print_answers(std::ostream& out, const json& document);

}  // namespace harness
