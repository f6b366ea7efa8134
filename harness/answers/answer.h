// Figures that theory knows of a scene: what a run makes of them, and what they should be.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "harness/scenes/scene.h"
#include "solvers/stepping/stepper.h"

namespace harness {

// Looks at one run, and reads one figure off it.
class Reading {
 public:
  virtual ~Reading() = default;
  // After each accepted step of h seconds.
  virtual void after(const inextensible::State& before, const inextensible::State& state,
                     double h) = 0;
  // Whether the value is known, so that the run may end.
  virtual bool done() const { return false; }
  // After the last step; NaN if the run does not tell.
  virtual double value() const = 0;
  // Observes the solver; null: nothing does.
  virtual inextensible::IterateObserver* observer() { return nullptr; }
};

struct AnswerScene {
  std::shared_ptr<const SceneType> type;
  SceneParameters parameters;  // complete: the scene is built from these
  Scene scene;
};
AnswerScene answer_scene(std::string_view name, const SceneParameters& given);

struct KnownAnswer {
  const char* name;  // a-z and _
  const char* scene;
  SceneParameters given;      // the others have the scene's own values
  const char* quantity;       // what is read off, with its unit
  const char* source;         // formula, author, year
  double strain_limit;        // of the runs: permissible |strain|
  std::vector<double> steps;  // s, each half of the one before
  std::function<double(const AnswerScene&)> exact;
  std::function<std::unique_ptr<Reading>(const AnswerScene&)> reading;
  bool needs_multipliers = false;  // of methods that show their iterates alone (Stepper::observe)
  bool continuum = false;  // exact in the limit of many vertices: runs tend to something nearby
};

std::span<const KnownAnswer> known_answers();
const KnownAnswer* find_answer(std::string_view name);

}  // namespace harness
