// What methods need for their rows: makers, and what their settings have in common.
#pragma once

#include <type_traits>
#include <utility>

#include "solvers/methods/backend.h"

namespace inextensible {

template <class Filter>
std::unique_ptr<VelocityFilter> make_filter(const Problem& problem, const BackendOptions& options,
                                            Along along) {
  if constexpr (std::is_constructible_v<Filter, const Problem&, const BackendOptions&, Along>)
    return std::make_unique<Filter>(problem, options, along);
  else
    return std::make_unique<Filter>(problem, options);
}

template <class Method>
std::unique_ptr<Stepper> make_step(std::shared_ptr<const Problem> problem,
                                   const BackendOptions& options) {
  return std::make_unique<Method>(std::move(problem), options);
}

constexpr double most_iterations = 1e9;  // fits an int
constexpr Range positive{.open = true}, fraction{0, 1},
    at_least_one{1, most_iterations, false, true}, count_from_zero{0, most_iterations, false, true};
constexpr SearchRange tunable_fraction{0, 1};

constexpr Range relaxation_range{0, 2, true};
// A chain of 640 links is relaxed best at 1.99.
constexpr SearchRange tunable_relaxation{0.5, 1.998, 2};
// The number of passes over all edges between two tests.
constexpr SearchRange tunable_passes{0, 2000};
// For methods that iterate until forces act along the edges at the end of the step.
constexpr SearchRange tunable_direction_tolerance{0.01, 100};
// Tolerances of linear solves.
constexpr Range forcing_range{0, 1, true};
constexpr SearchRange tunable_forcing{1e-4, 0.3};

inline SettingInfo iteration_limit(double initial, const char* what) {
  return {"max_iterations", initial, what, at_least_one};
}

inline SettingInfo least_iterations(double initial = 0) {
  return {
      "min_iterations", initial,
      "projections a step even where the candidate is permissible; 1 keeps slack from building up",
      count_from_zero, SearchRange{0, 2}};
}

constexpr const char* pass_target =
    "an edge that a pass corrects is brought to this fraction of the strain limit";

// The target of methods that solve for all edges at once: below 1, or they would only approach the
// limit.
inline SettingInfo projection_target() {
  return {
      "target", 0.0,
      "strained edges are brought to this fraction of the strain limit, those below it are kept",
      Range{0, 0.99}, SearchRange{0, 0.9}};
}

inline SettingInfo word_setting(const char* name, const char* initial, const char* meaning,
                                std::vector<const char*> choices) {
  return {.name = name, .initial = initial, .meaning = meaning, .choices = std::move(choices)};
}

inline SettingInfo schur_solver() {
  std::vector<const char*> names{"auto"};
  for (const SpdSolverRow& row : spd_solvers())
    if (row.takes != Takes::block_tridiagonal) names.push_back(row.name);
  return word_setting("linear_solver", "auto", "factorization of J W J^T", std::move(names));
}

}  // namespace inextensible
