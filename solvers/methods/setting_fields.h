// A method's own settings: a struct, and one table of its fields beside it. What the row tells of
// them (defaults are those of the struct), the checks, and the way from BackendOptions into the
// struct come from this table.
#pragma once

#include <string_view>
#include <type_traits>
#include <utility>

#include "solvers/methods/backend.h"
#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

constexpr Range positive{.open = true};
constexpr Range fraction{0, 1};
constexpr SearchRange tunable_fraction{0, 1};
constexpr double most_iterations = 1e9;  // that an int holds
constexpr Range at_least_one{1, most_iterations};
constexpr Range count_from_zero{0, most_iterations};

// A setting that is a double, a count or a word; `choices` are a word's.
template <class Struct>
struct SettingField {
  const char* name;
  std::variant<double Struct::*, int Struct::*, std::string_view Struct::*> member;
  const char* meaning;
  Range range = {};
  std::optional<SearchRange> tunable = {};
  bool departs = false;  // as SettingInfo's
  std::vector<const char*> choices = {};
};
template <class Struct>
SettingField<Struct> word_field(const char* name, std::string_view Struct::*member,
                                const char* meaning, std::vector<const char*> choices) {
  return {.name = name, .member = member, .meaning = meaning, .choices = std::move(choices)};
}
template <class Struct>
using SettingFields = std::vector<SettingField<Struct>>;

// For a row. A variant of a method gives other defaults. Inlined, GCC 12 warns of the words that a
// struct without words does not have.
template <class Struct>
[[gnu::noinline]] std::vector<SettingInfo> setting_infos(const SettingFields<Struct>& fields,
                                                         const Struct& defaults = {}) {
  std::vector<SettingInfo> infos;
  for (const SettingField<Struct>& field : fields) {
    SettingInfo info{field.name,  0.0,   field.meaning, field.choices,
                     field.range, false, field.tunable, field.departs};
    if (const auto* word = std::get_if<std::string_view Struct::*>(&field.member)) {
      info.initial = (defaults.**word).data();  // of a literal
    } else if (const auto* number = std::get_if<double Struct::*>(&field.member)) {
      info.initial = defaults.**number;
    } else {
      info.initial = static_cast<double>(defaults.*std::get<int Struct::*>(field.member));
      info.whole = true;
    }
    infos.push_back(std::move(info));
  }
  return infos;
}

// From complete and checked options, which must outlive the struct: words are views.
template <class Struct>
Struct settings_from(const SettingFields<Struct>& fields, const BackendOptions& options) {
  Struct settings;
  for (const SettingField<Struct>& field : fields) {
    const auto& value = options.settings.at(field.name);
    if (const auto* word = std::get_if<std::string_view Struct::*>(&field.member)) {
      settings.** word = std::get<std::string>(value);
    } else if (const auto* number = std::get_if<double Struct::*>(&field.member)) {
      settings.** number = std::get<double>(value);
    } else {
      settings.*std::get<int Struct::*>(field.member) = static_cast<int>(std::get<double>(value));
    }
  }
  if constexpr (requires { settings.strain_limit; }) settings.strain_limit = options.strain_limit;
  if constexpr (requires { settings.seed; }) settings.seed = options.seed;
  return settings;
}

// Method::Settings with Method::fields().
template <class Method>
typename Method::Settings settings_of(const BackendOptions& options) {
  return settings_from(Method::fields(), options);
}

// The `make_filter` of rows.
template <class Filter>
std::unique_ptr<VelocityFilter> make_filter(const Problem& problem, const BackendOptions& options,
                                            Along along) {
  if constexpr (std::is_constructible_v<Filter, const Problem&, const typename Filter::Settings&,
                                        Along>) {
    return std::make_unique<Filter>(problem, settings_of<Filter>(options), along);
  } else {
    return std::make_unique<Filter>(problem, settings_of<Filter>(options));
  }
}

// The `make` of rows of methods that are a time step of their own.
template <class Method>
std::unique_ptr<Stepper> make_step(std::shared_ptr<const Problem> problem,
                                   const BackendOptions& options) {
  return std::make_unique<Method>(std::move(problem), settings_of<Method>(options));
}

// What methods share.
std::vector<const char*> schur_solvers();  // "auto" and all that take some J W J^T
template <class Struct>
SettingField<Struct> schur_solver_field() {
  return word_field("linear_solver", &Struct::linear_solver,
                    "factorization of J W J^T, or conjugate gradients", schur_solvers());
}

constexpr const char* least_iterations =
    "projections a step even where the candidate is permissible; 1 keeps slack from building up";
constexpr SearchRange tunable_least_iterations{0, 2};

// Target of methods that solve for all edges at once. Below 1, or they would only come closer and
// closer to the limit.
constexpr const char* projection_target =
    "strained edges are brought to this fraction of the strain limit, those below it are kept";
constexpr Range below_limit{0, 0.99};
constexpr SearchRange tunable_below_limit{0, 0.9};
// Tolerance of iterative linear solvers.
constexpr Range forcing_range{0, 1, true};
constexpr SearchRange tunable_forcing{1e-4, 0.3};
constexpr Range relaxation_range{0, 2, true};
// A chain of 640 links is relaxed best at 1.99.
constexpr SearchRange tunable_relaxation{0.5, 1.998, 2};
// The number of passes over all edges between two tests.
constexpr SearchRange tunable_passes{0, 2000};
// For methods that iterate until forces act along the edges at the end of the step.
constexpr SearchRange tunable_direction_tolerance{0.01, 100};

}  // namespace inextensible
