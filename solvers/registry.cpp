#include "inextensible/registry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "inextensible/methods/dense_oracle.h"
#include "inextensible/methods/fast_projection.h"
#include "inextensible/methods/gauss_seidel.h"
#include "inextensible/methods/gauss_seidel_colored.h"
#include "inextensible/methods/icd.h"
#include "inextensible/methods/implicit_springs.h"
#include "inextensible/methods/jacobi.h"
#include "inextensible/methods/null_filter.h"
#include "inextensible/methods/rattle.h"
#include "inextensible/methods/shake.h"
#include "inextensible/stepping/bdf2_stepper.h"

namespace inextensible {
namespace {

using Shared = std::shared_ptr<const Problem>;

// Settings are complete and checked when they reach a factory (make_stepper).
double number(const BackendOptions& options, const char* name) {
  return std::get<double>(options.settings.at(name));
}
int integer(const BackendOptions& options, const char* name) {
  return static_cast<int>(number(options, name));
}
const std::string& word(const BackendOptions& options, const char* name) {
  return std::get<std::string>(options.settings.at(name));
}

template <class Filter, class... Arguments>
std::unique_ptr<Stepper> filter_stepper(Shared problem, const Arguments&... arguments) {
  auto filter = std::make_unique<Filter>(*problem, arguments...);
  return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
}

std::unique_ptr<Stepper> make_implicit_springs(Shared problem, const BackendOptions& o) {
  return std::make_unique<ImplicitSprings>(
      std::move(problem), ImplicitSprings::Settings{
                              number(o, "stiffness"), o.strain_limit, integer(o, "max_iterations"),
                              number(o, "newton_tolerance"), word(o, "linear_solver")});
}

std::unique_ptr<Stepper> make_jacobi(Shared problem, const BackendOptions& o) {
  return filter_stepper<Jacobi>(std::move(problem),
                                Jacobi::Settings{o.strain_limit, integer(o, "max_iterations"),
                                                 number(o, "target"), number(o, "relaxation")});
}

std::unique_ptr<Stepper> make_gauss_seidel(Shared problem, const BackendOptions& o) {
  return filter_stepper<GaussSeidel>(
      std::move(problem), GaussSeidel::Settings{o.strain_limit, integer(o, "max_iterations"),
                                                number(o, "target"), o.seed});
}

std::unique_ptr<Stepper> make_gauss_seidel_colored(Shared problem, const BackendOptions& o) {
  return filter_stepper<GaussSeidelColored>(
      std::move(problem),
      GaussSeidelColored::Settings{o.strain_limit, integer(o, "max_iterations"),
                                   number(o, "target"), number(o, "relaxation")});
}

std::unique_ptr<Stepper> make_shake(Shared problem, const BackendOptions& o) {
  return filter_stepper<Shake>(
      std::move(problem), Shake::Settings{o.strain_limit, integer(o, "max_iterations"),
                                          integer(o, "min_iterations"), word(o, "linear_solver")});
}

std::unique_ptr<Stepper> make_icd(Shared problem, const BackendOptions& o) {
  return filter_stepper<Icd>(
      std::move(problem),
      Icd::Settings{o.strain_limit, integer(o, "max_iterations"), number(o, "direction_tolerance"),
                    word(o, "linear_solver"), number(o, "cg_tolerance")});
}

FastProjection::Settings fast_projection_settings(const BackendOptions& o) {
  return {o.strain_limit, integer(o, "max_iterations"), integer(o, "min_iterations"),
          integer(o, "smoothing_sweeps"), word(o, "linear_solver")};
}

std::unique_ptr<Stepper> make_fast_projection(Shared problem, const BackendOptions& o) {
  return filter_stepper<FastProjection>(std::move(problem), fast_projection_settings(o));
}

std::unique_ptr<Stepper> make_fast_projection_bdf2(Shared problem, const BackendOptions& o) {
  auto filter = std::make_unique<FastProjection>(*problem, fast_projection_settings(o));
  return std::make_unique<Bdf2Stepper>(std::move(problem), std::move(filter));
}

std::unique_ptr<Stepper> make_fast_projection_bdf2opt(Shared problem, const BackendOptions& o) {
  auto filter = std::make_unique<FastProjection>(*problem, fast_projection_settings(o));
  return std::make_unique<Bdf2Stepper>(std::move(problem), std::move(filter), number(o, "blend"));
}

std::unique_ptr<Stepper> make_rattle(Shared problem, const BackendOptions& o) {
  return std::make_unique<Rattle>(
      std::move(problem), Shake::Settings{o.strain_limit, integer(o, "max_iterations"),
                                          integer(o, "min_iterations"), word(o, "linear_solver")});
}

std::unique_ptr<Stepper> make_null(Shared problem, const BackendOptions&) {
  return filter_stepper<Unconstrained>(std::move(problem));
}

std::unique_ptr<Stepper> make_reference(Shared problem, const BackendOptions&) {
  return filter_stepper<DenseReference>(std::move(problem));
}

const SettingInfo newton_iterations{"max_iterations", 50.0,
                                    "iterations a step before it is refused"};
// More, for the damped iterations of hard steps; ordinary ones take a handful.
const SettingInfo projections{"max_iterations", 200.0, "projections a step before it is refused"};
const SettingInfo sweeps{"max_iterations", 1e5, "sweeps a step before it is refused"};
const SettingInfo target{
    "target", 0.0, "a corrected edge is brought to this fraction of the strain limit, 0 to 1"};
constexpr const char* least_iterations =
    "projections a step even where the candidate is permissible; 1 keeps slack from building up";
constexpr const char* smoothing = "smoothing_sweeps";
constexpr const char* smoothing_meaning =
    "colored Gauss-Seidel sweeps after each projection, at most; none on chains";
const SettingInfo spd_solver{
    "linear_solver",
    "auto",
    "factorization of J W J^T, or conjugate gradients",
    {"auto", "tridiagonal", "fixed_pattern", "fixed_pattern_single", "fixed_pattern_mixed",
     "line_cg", "hybrid", "eigen_ldlt", "cholmod_simplicial", "cholmod_supernodal"}};

std::vector<Backend> built_in() {
  return {
      {"implicit_springs",
       "backward Euler on stiff springs, Newton with line search",
       Knob::stiffness,
       true,
       {{"stiffness", 1e4, "spring stiffness EA in N; sweeps search it"},
        {"max_iterations", 100.0, "Newton iterations a step before it is refused"},
        {"newton_tolerance", 0.1, "last Newton step, in strain limit times shortest rest length"},
        {"linear_solver",
         "auto",
         "factorization of the Hessian",
         {"auto", "block_tridiagonal", "fixed_pattern", "eigen_ldlt", "cholmod_simplicial",
          "cholmod_supernodal"}}},
       make_implicit_springs,
       Direction::springs},
      {"jacobi",
       "strain limiting, all edges at once and averaged",
       Knob::strain_limit,
       true,
       {sweeps, target, {"relaxation", 1.8, "times the averaged correction, above 0 and below 2"}},
       make_jacobi,
       Direction::local},
      {"gauss_seidel",
       "strain limiting, edge after edge in random order",
       Knob::strain_limit,
       true,
       {sweeps, target},
       make_gauss_seidel,
       Direction::local},
      {"gauss_seidel_colored",
       "the same, edges that share no vertex side by side in vectors",
       Knob::strain_limit,
       true,
       {sweeps, target, {"relaxation", 1.0, "times the correction, above 0 and below 2"}},
       make_gauss_seidel_colored,
       Direction::local},
      {"shake",
       "constraint direction from the start of the step",
       Knob::strain_limit,
       true,
       {newton_iterations, {"min_iterations", 0.0, least_iterations}, spd_solver},
       make_shake,
       Direction::start},
      {"icd",
       "implicit constraint direction: positions and multipliers together",
       Knob::strain_limit,
       true,
       {newton_iterations,
        {"direction_tolerance", 0.1,
         "largest |F| of a vertex, in strain limit times shortest rest length"},
        {"cg_tolerance", 0.03, "accuracy of a Newton step by projected_cg"},
        {"linear_solver",
         "auto",
         "of the KKT system",
         {"auto", "projected_cg", "quasi_definite", "umfpack"}}},
       make_icd,
       Direction::current},
      {"fast_projection",
       "Algorithm 1 of Goldenthal et al. 2007",
       Knob::strain_limit,
       true,
       {projections,
        {"min_iterations", 0.0, least_iterations},
        {smoothing, 0.0, smoothing_meaning},
        spd_solver},
       make_fast_projection,
       Direction::current},
      {"fast_projection_smoothed",
       "the same, each projection followed by some colored Gauss-Seidel sweeps",
       Knob::strain_limit,
       true,
       {projections,
        {"min_iterations", 0.0, least_iterations},
        {smoothing, 30.0, smoothing_meaning},
        spd_solver},
       make_fast_projection,
       Direction::current},
      {"fast_projection_bdf2",
       "fast projection inside the two-step formula BDF2: second order",
       Knob::strain_limit,
       true,
       {projections,
        {"min_iterations", 1.0, least_iterations},
        {smoothing, 30.0, smoothing_meaning},
        spd_solver},
       make_fast_projection_bdf2,
       Direction::current},
      {"rattle",
       "SHAKE with velocities projected as well (Andersen 1983): second order, no damping",
       Knob::strain_limit,
       true,
       {newton_iterations, {"min_iterations", 1.0, least_iterations}, spd_solver},
       make_rattle,
       Direction::start},
      {"fast_projection_bdf2opt",
       "the same with half the error constant: BDF2 blended with BDF3",
       Knob::strain_limit,
       false,
       {projections,
        {"min_iterations", 1.0, least_iterations},
        {smoothing, 30.0, smoothing_meaning},
        {"blend", 0.48, "of BDF3 in the formula, 0 to 0.48 (A-stable)"},
        spd_solver},
       make_fast_projection_bdf2opt,
       Direction::current},
      {"null",
       "unconstrained step only: what the scene and the harness cost",
       Knob::none,
       false,
       {},
       make_null},
      {"reference",
       "dense Newton to 1e-12, small problems: the oracle of the tests",
       Knob::none,
       false,
       {},
       make_reference},
  };
}

struct Table {
  std::vector<Backend> rows = built_in();
  std::size_t built_in_rows = rows.size();
};

Table& table() {
  static Table all;
  return all;
}

std::string quoted(std::string_view name) { return "'" + std::string(name) + "'"; }

// The backend's settings with the given ones put in, checked.
Settings complete(const Backend& backend, const Settings& given) {
  Settings all;
  for (const SettingInfo& info : backend.settings) {
    if (const auto* text = std::get_if<const char*>(&info.initial)) {
      all[info.name] = std::string(*text);
    } else {
      all[info.name] = std::get<double>(info.initial);
    }
  }
  for (const auto& [name, value] : given) {
    const auto place = all.find(name);
    const std::string where = "solver " + quoted(backend.name) + ": setting " + quoted(name);
    if (place == all.end()) throw std::invalid_argument(where + " does not exist");
    if (place->second.index() != value.index()) {
      throw std::invalid_argument(where +
                                  (value.index() == 0 ? " must be a word" : " must be a number"));
    }
    const SettingInfo& info =
        *std::find_if(backend.settings.begin(), backend.settings.end(),
                      [&name = name](const SettingInfo& s) { return name == s.name; });
    if (const auto* number = std::get_if<double>(&value)) {
      if (!std::isfinite(*number) || *number < 0)
        throw std::invalid_argument(where + " must be finite and not negative");
    } else if (const auto& text = std::get<std::string>(value);
               std::find(info.choices.begin(), info.choices.end(), text) == info.choices.end()) {
      std::string choices;
      for (const char* choice : info.choices) {
        if (!choices.empty()) choices += ", ";
        choices += choice;
      }
      throw std::invalid_argument(where + " is " + quoted(text) + ", must be one of: " + choices);
    }
    place->second = value;
  }
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
    all.push_back(row);
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
  BackendOptions resolved = options;
  resolved.settings = complete(*backend, options.settings);
  return backend->make(std::move(problem), resolved);
}

}  // namespace inextensible
