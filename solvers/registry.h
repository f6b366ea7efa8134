// The list of all backends: tests, sweeps, figures and the command line iterate it. A new backend
// is its own file pair and one row in registry.cpp, or a plug-in (plugin.h).
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "inextensible/stepping/stepper.h"

namespace inextensible {

// A setting of one backend, with its default and, for words, what may be chosen.
struct SettingInfo {
  const char* name;
  std::variant<double, const char*> initial;
  const char* meaning;
  std::vector<const char*> choices = {};
};

using Settings = std::map<std::string, std::variant<double, std::string>>;

struct BackendOptions {
  double strain_limit = 0.01;  // permissible |strain|, > 0
  std::uint64_t seed = 1;      // of methods that draw random numbers
  Settings settings = {};      // the backend's own; missing ones take their default
};

// What the harness may turn to make a run keep its strain limit.
enum class Knob { strain_limit, stiffness, none };

struct Backend {
  const char* name;
  const char* summary;  // one line
  Knob knob;
  bool contestant;  // appears in figures and rankings
  std::vector<SettingInfo> settings;
  std::unique_ptr<Stepper> (*make)(std::shared_ptr<const Problem>, const BackendOptions&);
};

std::span<const Backend> backends();
// Appends rows from outside this library. At program start, before anything else: what backends()
// and find_backend() gave before is no longer valid. Throws std::invalid_argument, having added
// nothing, for a name that is taken or not made of a-z, 0-9 and _ (it becomes part of point ids),
// and for a row without `make` or summary.
void add_backends(std::span<const Backend> rows);
bool is_built_in(std::string_view name);             // a row of registry.cpp
const Backend* find_backend(std::string_view name);  // null if there is none

// Throws std::invalid_argument for an unknown backend, setting or choice, or a strain limit that is
// not positive.
std::unique_ptr<Stepper> make_stepper(std::string_view name, std::shared_ptr<const Problem> problem,
                                      const BackendOptions& options);

}  // namespace inextensible
