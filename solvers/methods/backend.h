// A method as the program knows it: one row, at the end of the method's own .cpp, or made of a
// plug-in's (c_method.h). Whatever else the program needs to know of a method it reads from the
// row; nothing asks for a method by its name.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

// Numbers from `least` to `largest`; `open`: without these two; `whole`: integers only.
struct Range {
  double least = 0;
  double largest = std::numeric_limits<double>::infinity();
  bool open = false, whole = false;

  bool contains(double number) const;  // false on NaN and infinities
};

// Where a search for a setting's best value looks. `bound`: what lies beyond the largest end and
// must not be reached, as 2 by a relaxation (Young 1954); the distance to it is then what matters.
struct SearchRange {
  double least = 0, largest = 0;
  std::optional<double> bound = {};
};

// A setting of one backend: a number within a range, or one of several words.
struct SettingInfo {
  const char* name;
  std::variant<double, const char*> initial;
  const char* meaning;
  Range range = {};
  std::optional<SearchRange> tunable = {};
  // The setting departs from the published method: it is searched in other time steppers only.
  bool departs = false;
  std::vector<const char*> choices = {};
};

using Settings = std::map<std::string, std::variant<double, std::string>>;

struct BackendOptions {
  double strain_limit = 0.01;  // largest |strain| permitted, > 0
  std::uint64_t seed = 1;      // of methods that draw random numbers
  Settings settings = {};      // the backend's own; missing ones take their default
  // Where the steps will begin, for set-ups that need positions, or null. Valid during `make` only.
  const State* start = nullptr;

  // What a method's constructor reads, of complete settings.
  double number(const char* name) const { return std::get<double>(settings.at(name)); }
  int count(const char* name) const { return static_cast<int>(number(name)); }
  const std::string& word(const char* name) const {
    return std::get<std::string>(settings.at(name));
  }
};

// What the harness may turn to make a run keep its strain limit: the limit itself, which the method
// then promises; a stiffness; the time step alone. none: no run is asked to keep one.
enum class StrainControl { strain_limit, stiffness, none, time_step };

// Where a method's constraint forces take their direction from: each edge from its own ends in turn
// (local), from springs, or the gradient at the start of the step, at the current iterate (or
// halfway to it), or at the end, which is solved for together with the multipliers.
enum class Direction { none, local, start, current, springs, end };

// What time the velocities of a state belong to. half_step: v^n = (x^n - x^{n-1}) / h is that of
// the middle of the step before, as in symplectic and in backward Euler, hence in every velocity
// filter behind FilterStepper; such a method starts from start_half_step_back
// (systems/constrained_acceleration.h). whole_step: x and v are those of one instant.
enum class Velocities { half_step, whole_step };

// Who offers a method: the paper compares it, this project adds it, others have published it, or an
// engine has it.
enum class Origin { paper, project, literature, engine, elsewhere };

// A method in its published time stepper. The registry completes it, and adds a row for each other
// time stepper that suits it: a contestant is method@stepper.
struct Backend {
  const char* name;     // a-z, 0-9 and _; in another stepper than the published one, method@stepper
  const char* summary;  // one line
  StrainControl strain_control = StrainControl::strain_limit;
  bool contestant = true;  // appears in figures and rankings
  std::vector<SettingInfo> settings = {};
  // A velocity filter has `make_filter` and works in any stepper; where its corrections point
  // concerns it only if it `takes_middle`. Other methods have `make`: a time step of their own.
  std::function<std::unique_ptr<Stepper>(std::shared_ptr<const Problem>, const BackendOptions&)>
      make = nullptr;
  std::function<std::unique_ptr<VelocityFilter>(const Problem&, const BackendOptions&, Along along)>
      make_filter = nullptr;
  bool takes_middle = false;
  Direction direction = Direction::none;
  const char* citation = "";  // author and year
  Origin origin = Origin::elsewhere;
  const char* label = "";   // in figures; empty: the name
  const char* family = "";  // the method whose colour it shares in figures; empty: its own
  // The method that this one is on a chain, step for step, where suites leave it out; empty: none.
  const char* same_on_chains = "";
  bool shows_iterates = false;  // Stepper::observe sees the iterates and multipliers of each step
  // What the method can do with a problem; make_stepper refuses those that have more.
  bool takes_shear = true, takes_collider = true;
  // To a velocity filter bending and drag are forces like gravity, to others part of the energy.
  bool takes_bending = true, takes_drag = true, takes_implicit_forces = true;
  Velocities velocities = Velocities::half_step;
  // Whether only what acts from outside changes linear momentum, and a step's forces act along
  // edges, however far the method iterates. One that moves vertices one by one, or lets forces turn
  // towards their edges, has that at convergence only.
  bool conserves_momentum = true;
  // `make` is backward Euler, and does not depend on which states it is given: BDF2 takes it from
  // one that it extrapolates.
  bool backward_euler = false;
  // The time stepper and its origin; `method`: the name without it. The registry fills these in; a
  // row names its published stepper if that is not backward Euler.
  const char* stepper = "";
  Origin stepper_origin = Origin::paper;
  const char* method = "";
};

// The second axis of contestants: the time steppers that a method may work in. A method enforces
// constraints or carries stiff springs; the stepper takes it from one state to the next.
struct TimeStepper {
  const char* name;  // what follows the @
  std::unique_ptr<Stepper> (*around)(std::shared_ptr<const Problem>, const Backend& method,
                                     const BackendOptions&);
  Origin origin = Origin::paper;
  const char* citation = "";
  const char* phrase = "";  // after a method's label: "in BDF2"; empty for a published stepper
  Velocities velocities = Velocities::half_step;
  Along along = Along::edges;              // where corrections of a filter point
  std::vector<SettingInfo> settings = {};  // the stepper's own
};

std::span<const TimeStepper> time_steppers();

// Why the pair makes no sense, as the end of a sentence; null: it does.
const char* mismatch(const Backend& method, const TimeStepper& stepper);

// The part of the problem that the method does not take, in words; null: it takes all.
const char* part_not_taken(const Backend& backend, const Problem& problem);

// The given settings, checked, and the defaults of the others. Throws std::invalid_argument, naming
// solver and setting, for one that does not exist, is of the wrong kind or out of its range.
Settings complete_settings(const Backend& backend, const Settings& given);

}  // namespace inextensible
