// The list of all backends: tests, sweeps, figures and the command line iterate it. A new backend
// is its own file and one line in registry.cpp, or a plug-in (inextensible.h).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "solvers/methods/backend.h"

namespace inextensible {

std::span<const Backend> backends();
// Appends rows from outside this library, velocity filters in all time steppers that suit them. At
// program start, before anything else: what backends() and find_backend() gave before is no longer
// valid. Throws std::invalid_argument, having added nothing, for a name that is taken or not made
// of a-z, 0-9 and _ (it becomes part of point ids), and for a row without summary, or with neither
// or both of `make` and `make_filter`.
void add_backends(std::span<const Backend> rows);
bool is_built_in(std::string_view name);  // a row of registry.cpp
// Null if there is none. A method in its published time stepper has two names: gauss_seidel and
// gauss_seidel@backward_euler.
const Backend* find_backend(std::string_view name);
// Why method@stepper is not in backends() although its method is; otherwise empty.
std::string why_no_pair(std::string_view name);

// Throws std::invalid_argument for an unknown backend, setting or choice, a strain limit that is
// not positive, or a problem with a part that the backend does not take.
std::unique_ptr<Stepper> make_stepper(std::string_view name, std::shared_ptr<const Problem> problem,
                                      const BackendOptions& options);
// The velocity filter alone; null where the method is a time step of its own. Throws likewise.
std::unique_ptr<VelocityFilter> make_velocity_filter(std::string_view name, const Problem& problem,
                                                     const BackendOptions& options,
                                                     Along along = Along::edges);

}  // namespace inextensible
