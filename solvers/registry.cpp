#include "solvers/registry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solvers/methods/augmented_vbd.h"
#include "solvers/methods/dense_oracle.h"
#include "solvers/methods/fast_projection.h"
#include "solvers/methods/fast_projection_adaptive.h"
#include "solvers/methods/gauss_seidel.h"
#include "solvers/methods/gauss_seidel_colored.h"
#include "solvers/methods/icd.h"
#include "solvers/methods/implicit_springs.h"
#include "solvers/methods/jacobi.h"
#include "solvers/methods/null_filter.h"
#include "solvers/methods/projective_dynamics.h"
#include "solvers/methods/rattle.h"
#include "solvers/methods/shake.h"
#include "solvers/methods/soft_step.h"
#include "solvers/methods/strips.h"
#include "solvers/methods/vertex_block_descent.h"
#include "solvers/methods/xpbd_small_steps.h"

namespace inextensible {
namespace {

using Shared = std::shared_ptr<const Problem>;

std::vector<Backend> built_in() {
  return {
      implicit_springs_row(),
      jacobi_row(),
      gauss_seidel_row(),
      gauss_seidel_colored_row(),
      shake_row(),
      icd_row(),
      fast_projection_row(),
      fast_projection_bdf2_row(),
      rattle_row(),
      strips_row(),
      strips_bdf2_row(),
      strips_midpoint_row(),
      fast_projection_adaptive_row(),
      fast_projection_adaptive_bdf2_row(),
      xpbd_small_steps_row(),
      fast_projection_bdf2opt_row(),
      vertex_block_descent_row(),
      augmented_vbd_row(),
      projective_dynamics_row(),
      soft_step_row(),
      null_row(),
      oracle_row(),
  };
}

std::string quoted(std::string_view name) { return "'" + std::string(name) + "'"; }

// What a row may leave empty.
Backend completed(Backend row) {
  if (!row.citation) row.citation = "";
  if (!row.label || !*row.label) row.label = row.name;
  if (!row.family || !*row.family) row.family = row.name;
  return row;
}

std::vector<Backend> completed(std::vector<Backend> rows) {
  for (Backend& row : rows) row = completed(std::move(row));
  return rows;
}

struct Table {
  std::vector<Backend> rows = completed(built_in());
  std::size_t built_in_rows = rows.size();
};

Table& table() {
  static Table all;
  return all;
}

void check_row(const Backend& row, std::span<const Backend> others) {
  const std::string_view name = row.name ? row.name : "";
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), fits))
    throw std::invalid_argument("solver " + quoted(name) + ": a name is made of a-z, 0-9 and _");
  if (std::any_of(others.begin(), others.end(),
                  [name](const Backend& b) { return b.name == name; }))
    throw std::invalid_argument("there is a solver " + quoted(name) + " already");
  if (!row.make || !row.summary)
    throw std::invalid_argument("solver " + quoted(name) + " has no factory or no summary");
}

}  // namespace

std::span<const Backend> backends() { return table().rows; }

void add_backends(std::span<const Backend> rows) {
  std::vector<Backend> all = table().rows;
  for (const Backend& row : rows) {
    check_row(row, all);
    all.push_back(completed(row));
  }
  table().rows.swap(all);
}

const Backend* find_backend(std::string_view name) {
  const auto rows = backends();
  const auto place =
      std::find_if(rows.begin(), rows.end(), [name](const Backend& b) { return b.name == name; });
  return place == rows.end() ? nullptr : &*place;
}

bool is_built_in(std::string_view name) {
  const Backend* backend = find_backend(name);
  return backend && backend < backends().data() + table().built_in_rows;
}

std::unique_ptr<Stepper> make_stepper(std::string_view name, Shared problem,
                                      const BackendOptions& options) {
  const Backend* backend = find_backend(name);
  if (!backend) throw std::invalid_argument("no solver " + quoted(name));
  if (!(options.strain_limit > 0) || !std::isfinite(options.strain_limit)) {
    throw std::invalid_argument("strain limit is " + std::to_string(options.strain_limit) +
                                ", must be positive");
  }
  if (const char* part = part_not_taken(*backend, *problem))
    throw std::invalid_argument("solver " + quoted(name) + " takes no " + part);
  BackendOptions resolved = options;
  resolved.settings = complete_settings(*backend, options.settings);
  return backend->make(std::move(problem), resolved);
}

}  // namespace inextensible
