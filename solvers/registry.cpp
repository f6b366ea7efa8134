#include "solvers/registry.h"

#include <set>
#include <stdexcept>

// All methods, in the order of tables; each has its row in its own file in solvers/methods.
#define INEXTENSIBLE_METHODS(ROW) \
  ROW(implicit_springs)           \
  ROW(jacobi)                     \
  ROW(gauss_seidel)               \
  ROW(gauss_seidel_colored)       \
  ROW(shake)                      \
  ROW(icd)                        \
  ROW(fast_projection)            \
  ROW(rattle)                     \
  ROW(yarn_projection)            \
  ROW(fast_projection_adaptive)   \
  ROW(pbd_substeps)               \
  ROW(vertex_block_descent)       \
  ROW(augmented_vbd)              \
  ROW(admm)                       \
  ROW(soft_step)                  \
  ROW(null)                       \
  ROW(dense_newton)

namespace inextensible {

#define DECLARED_ROW(method) Backend method##_row();
INEXTENSIBLE_METHODS(DECLARED_ROW)
#undef DECLARED_ROW

namespace {

using Shared = std::shared_ptr<const Problem>;

std::vector<Backend> built_in() {
#define LISTED_ROW(method) method##_row(),
  std::vector<Backend> rows{INEXTENSIBLE_METHODS(LISTED_ROW)};
#undef LISTED_ROW
  std::erase_if(rows, [](const Backend& row) { return !row.name; });  // not in this library
  return rows;
}

std::string quoted(std::string_view name) { return "'" + std::string(name) + "'"; }

// Rows point to their words, those of pairs as well.
const char* kept(std::string words) {
  static std::set<std::string> all;
  return all.insert(std::move(words)).first->c_str();
}

std::string joined(const char* words, const char* separator, const char* more) {
  return *words && *more ? std::string(words) + separator + more
                         : std::string(*words ? words : more);
}

std::string pair_name(const char* method, const char* stepper) {
  return std::string(method) + "@" + stepper;
}

// What a row may leave empty.
Backend completed(Backend row) {
  if (!row.citation) row.citation = "";
  if (!row.label || !*row.label) row.label = row.name;
  if (!row.family || !*row.family) row.family = row.name;
  row.method = row.name;
  if (!*row.stepper) row.stepper = row.make_filter || row.backward_euler ? "backward_euler" : "own";
  for (SettingInfo& setting : row.settings)
    if (setting.departs) setting.tunable.reset();
  return row;
}

// The row of `method` in another stepper than its published one.
Backend paired(const Backend& method, const TimeStepper& stepper) {
  Backend row = completed(method);
  row.name = kept(pair_name(method.name, stepper.name));
  row.summary = kept(joined(method.summary, ", ", stepper.phrase));
  row.citation = kept(joined(row.citation, "; ", stepper.citation));
  row.label = kept(joined(row.label, " ", stepper.phrase));
  row.stepper = stepper.name;
  row.stepper_origin = stepper.origin;
  row.velocities = stepper.velocities;
  if (*method.same_on_chains)
    row.same_on_chains = kept(pair_name(method.same_on_chains, stepper.name));
  // Directions turn from iterate to iterate, hence forces that have been applied.
  if (stepper.along == Along::middle) row.conserves_momentum = false;
  row.settings = method.settings;
  row.settings.insert(row.settings.end(), stepper.settings.begin(), stepper.settings.end());
  return row;
}

// All pairs, those of one method side by side.
std::vector<Backend> in_all_steppers(std::span<const Backend> methods) {
  std::vector<Backend> rows;
  for (const Backend& method : methods) {
    const Backend published = completed(method);
    rows.push_back(published);
    if (!method.contestant) continue;
    for (const TimeStepper& stepper : time_steppers())
      if (stepper.name != std::string_view(published.stepper) && !mismatch(published, stepper))
        rows.push_back(paired(method, stepper));
  }
  return rows;
}

struct Table {
  std::vector<Backend> rows = in_all_steppers(built_in());
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
  if (name.empty() || !std::ranges::all_of(name, fits))
    throw std::invalid_argument("solver " + quoted(name) + ": a name is made of a-z, 0-9 and _");
  if (std::ranges::find(others, name, &Backend::name) != others.end())
    throw std::invalid_argument("there is a solver " + quoted(name) + " already");
  if ((row.make != nullptr) == (row.make_filter != nullptr) || !row.summary)
    throw std::invalid_argument("solver " + quoted(name) +
                                " has no summary, or not one of `make` and `make_filter`");
}

const Backend& row_of(std::string_view name) {
  const Backend* backend = find_backend(name);
  if (!backend) throw std::invalid_argument("no solver " + quoted(name));
  return *backend;
}

// With all settings.
BackendOptions checked(const Backend& backend, const Problem& problem, BackendOptions options) {
  if (!(options.strain_limit > 0) || !std::isfinite(options.strain_limit))
    throw std::invalid_argument("strain limit is " + std::to_string(options.strain_limit) +
                                ", must be positive");
  if (const char* part = part_not_taken(backend, problem))
    throw std::invalid_argument("solver " + quoted(backend.name) + " takes no " + part);
  options.settings = complete_settings(backend, options.settings);
  return options;
}

}  // namespace

std::span<const Backend> backends() { return table().rows; }

void add_backends(std::span<const Backend> rows) {
  std::vector<Backend> all = table().rows;
  for (const Backend& row : rows) {
    check_row(row, all);
    for (Backend& pair : in_all_steppers({&row, 1})) all.push_back(std::move(pair));
  }
  table().rows.swap(all);
}

const Backend* find_backend(std::string_view name) {
  const auto rows = backends();
  const auto place = std::ranges::find_if(rows, [name](const Backend& b) {
    // By its whole name in its published stepper too.
    return b.name == name ||
           (name.find('@') != name.npos && name == pair_name(b.method, b.stepper));
  });
  return place == rows.end() ? nullptr : &*place;
}

std::string why_no_pair(std::string_view name) {
  const std::size_t at = name.find('@');
  const Backend* method = at == name.npos ? nullptr : find_backend(name.substr(0, at));
  if (!method) return {};
  std::string names;
  for (const TimeStepper& stepper : time_steppers()) {
    if (const char* reason = mismatch(*method, stepper); stepper.name == name.substr(at + 1))
      return reason ? reason : "";
    names += (names.empty() ? "" : ", ") + std::string(stepper.name);
  }
  return "there is no such time stepper; there are: " + names;
}

bool is_built_in(std::string_view name) {
  const Backend* backend = find_backend(name);
  return backend && backend < backends().data() + table().built_in_rows;
}

std::unique_ptr<Stepper> make_stepper(std::string_view name, Shared problem,
                                      const BackendOptions& options) {
  const Backend& backend = row_of(name);
  const BackendOptions resolved = checked(backend, *problem, options);
  for (const TimeStepper& stepper : time_steppers())
    if (stepper.around && stepper.name == std::string_view(backend.stepper))
      return stepper.around(std::move(problem), backend, resolved);
  return backend.make(std::move(problem), resolved);
}

std::unique_ptr<VelocityFilter> make_velocity_filter(std::string_view name, const Problem& problem,
                                                     const BackendOptions& options, Along along) {
  const Backend& backend = row_of(name);
  if (!backend.make_filter) return nullptr;
  return backend.make_filter(problem, checked(backend, problem, options), along);
}

}  // namespace inextensible
