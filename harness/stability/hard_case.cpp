#include "harness/stability/hard_case.h"

#include <SuiteSparseQR.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/text.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::ProblemParts;
using inextensible::State;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double g = 9.81;

const std::set<std::string> current_direction{"fast_projection", "fast_projection_smoothed",
                                              "fast_projection_bdf2", "fast_projection_bdf2opt",
                                              "icd"};
const std::set<std::string> start_direction{"shake", "rattle"};
const std::set<std::string> strain_limiting{"jacobi", "gauss_seidel", "gauss_seidel_colored"};
const std::set<std::string> springs{"implicit_springs"};
const std::set<std::string> everyone{};

const std::set<Outcome> survives{Outcome::survived};
const std::set<Outcome> refuses{Outcome::refused};
const std::set<Outcome> either{Outcome::survived, Outcome::refused};
const std::set<Outcome> slow{Outcome::survived, Outcome::refused, Outcome::timeout};

std::size_t as_size(int i) { return static_cast<std::size_t>(i); }

// ---- Parts of scenes ----

struct Mesh {
  ProblemParts parts;
  State start;
  double size = 1;  // m
};

Mesh points(int n, double mass) {
  Mesh mesh;
  mesh.parts.mass.assign(as_size(n), mass);
  mesh.start.x.setZero(3, n);
  mesh.start.v.setZero(3, n);
  return mesh;
}

void join(Mesh& mesh, int a, int b, double rest_length) {
  mesh.parts.edges.push_back({a, b});
  mesh.parts.rest_length.push_back(rest_length);
}

// `links` links on a line from the origin along `direction`, 1 m and 1 kg in all.
Mesh chain(int links, const Eigen::Vector3d& direction = {1, 0, 0}, bool pinned = true) {
  const double l = 1.0 / links;
  Mesh mesh = points(links + 1, 1.0 / (links + 1));
  for (int i = 0; i <= links; ++i) {
    mesh.start.x.col(i) = i * l * direction;
    if (i > 0) join(mesh, i - 1, i, l);
  }
  if (pinned) mesh.parts.pinned = {0};
  return mesh;
}

// n x n vertices, 1 m wide and 0.2 kg, horizontal; without shear. Pinned at two corners.
Mesh cloth(int n, bool diagonals = false) {
  const double l = 1.0 / (n - 1);
  Mesh mesh = points(n * n, 0.2 / (n * n));
  const auto vertex = [n](int i, int j) { return i * n + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.start.x.col(vertex(i, j)) << j * l, 0, i * l;
      if (j + 1 < n) join(mesh, vertex(i, j), vertex(i, j + 1), l);
      if (i + 1 < n) join(mesh, vertex(i, j), vertex(i + 1, j), l);
      if (diagonals && i + 1 < n && j + 1 < n)
        join(mesh, vertex(i, j), vertex(i + 1, j + 1), std::sqrt(2.0) * l);
    }
  }
  mesh.parts.pinned = {vertex(0, 0), vertex(0, n - 1)};
  return mesh;
}

// Springs promise no limit: a stiffness that would keep it in a fall of a few weights.
Trial trial_of(Scene scene, double step, int steps, double strain_limit = 0.01) {
  const Problem& problem = *scene.problem;
  Trial trial;
  trial.slack = strain_limit * problem.longest_rest_length();
  trial.step = step;
  trial.steps = steps;
  trial.strain_limit = strain_limit;
  trial.settings["implicit_springs"] = {
      {"stiffness", 20 * g * problem.total_mass() / strain_limit}};
  trial.scene = std::move(scene);
  return trial;
}

Trial trial_of(Scene scene, double step, double strain_limit = 0.01) {
  const int steps = static_cast<int>(std::lround(scene.duration / step));
  return trial_of(std::move(scene), step, steps, strain_limit);
}

Trial trial_of(Mesh mesh, double step, int steps, double strain_limit = 0.01) {
  Scene scene;
  scene.size = mesh.size;
  scene.start = std::move(mesh.start);
  scene.problem = std::make_shared<const Problem>(std::move(mesh.parts));
  return trial_of(std::move(scene), step, steps, strain_limit);
}

Scene scene_of(const char* name, const SceneParameters& given) {
  const SceneType& type = *find_scene(name);
  return type.build(complete_parameters(type, given));
}

void add_noise(Positions& x, const std::vector<int>& pinned, double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> noise(-size, size);
  const Positions before = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise(random);
  for (const int pin : pinned) x.col(pin) = before.col(pin);
}

// ---- Q1 to Q4 (Goldenthal et al. 2007, Figure 2): weightless, one step that takes vertices to
// given candidates ----

constexpr double q_step = 0.01, q_limit = 1e-6;
// The closest point of the manifold is at most twice as far from the start as the candidate is, so
// that a velocity filter may return up to four times the candidate's kinetic energy.
constexpr double closest_point_energy = 3;

Trial one_step(Mesh mesh, const Positions& candidate) {
  mesh.parts.gravity.setZero();
  mesh.start.v = (candidate - mesh.start.x) / q_step;
  Trial trial = trial_of(std::move(mesh), q_step, 1, q_limit);
  trial.settings["implicit_springs"] = {{"stiffness", 1e6}};
  trial.energy_tolerance = closest_point_energy;
  trial.slack = std::sqrt(2 * q_limit);  // sideways, of an edge pulled taut
  return trial;
}

// An edge of 1 m along x, pinned at the origin; its free end goes to (x, y).
Trial one_edge(double x, double y) {
  Mesh mesh = points(2, 1);
  mesh.start.x(0, 1) = 1;
  mesh.parts.pinned = {0};
  join(mesh, 0, 1, 1);
  Positions candidate = mesh.start.x;
  candidate.col(1) << x, y, 0;
  return one_step(std::move(mesh), candidate);
}

// Two edges of 1 m from pins at (-half_span, 0) and (half_span, 0) to a vertex between them that
// goes from (0, y) to (0, candidate_y).
Trial two_edges(double half_span, double y, double candidate_y) {
  Mesh mesh = points(3, 1);
  mesh.start.x.col(0) << -half_span, 0, 0;
  mesh.start.x.col(1) << 0, y, 0;
  mesh.start.x.col(2) << half_span, 0, 0;
  mesh.parts.pinned = {0, 2};
  join(mesh, 0, 1, 1);
  join(mesh, 1, 2, 1);
  Positions candidate = mesh.start.x;
  candidate(1, 1) = candidate_y;
  return one_step(std::move(mesh), candidate);
}

void add_configurations(std::vector<HardCase>& cases, const std::vector<double>& distances) {
  cases.push_back({"Q1",
                   "Q1",
                   "an edge turns by 90 degrees and doubles its length",
                   [] { return one_edge(0, 2); },
                   {{start_direction, refuses, "no multiple of the old direction reaches length l"},
                    {everyone, survives, "the edge shortens along its own direction"}}});
  cases.push_back(
      {"Q2",
       "Q2",
       "an edge turns by 90 degrees: J(x0) W J(x^n)^T = 0",
       [] { return one_edge(0, 0.5); },
       {{start_direction, either,
         "Newton's own matrix is singular; the one frozen at x^n (Barth et al. 1994) is "
         "not, and may reach the solution that exists"},
        {everyone, survives, "J W J^T with one J is regular"}}});
  cases.push_back(
      {"Q3",
       "Q3",
       "two edges made parallel by the step: J(x0) is rank deficient",
       [] { return two_edges(0.6, 0.8, 0); },
       {{start_direction, either, "J(x^n) is regular"},
        {{"implicit_springs"}, either, "a saddle of the energy"},
        {everyone, either,
         "no direction at x0 changes both lengths, save by rounding; a smaller step has one"}}});
  cases.push_back({"Q4",
                   "Q4",
                   "a straight chain between two pins: J(x^n) is rank deficient",
                   [] { return two_edges(1, 0, 0.01); },
                   {{start_direction, refuses, "J(x^n) W J(x^n)^T is singular"},
                    {strain_limiting, slow, "taut: convergence slower than linear"},
                    {everyone, survives, "J(x^n) is not used"}}});
  for (const double d : distances) {
    cases.push_back({"Q1 near",
                     "Q1/" + number_text(d),
                     "the candidate too long by this much only",
                     [d] { return one_edge(0, 1 + d); },
                     {{start_direction, either, "no solution beyond the limit"},
                      {everyone, survives, "as Q1"}}});
    cases.push_back(
        {"Q2 near",
         "Q2/" + number_text(d),
         "J(x0) W J(x^n)^T of this size",
         [d] { return one_edge(d, 0.5); },
         {{start_direction, either, "nearly singular"}, {everyone, survives, "as Q2"}}});
    cases.push_back(
        {"Q3 near",
         "Q3/" + number_text(d),
         "the candidate beside the line of the pins",
         [d] { return two_edges(0.6, 0.8, 0.8 * d); },
         {{start_direction, either, "J(x^n) is regular"}, {everyone, either, "nearly singular"}}});
    cases.push_back({"Q4 near",
                     "Q4/" + number_text(d),
                     "a sagging chain between two pins",
                     [d] { return two_edges(std::sqrt(1 - d * d), d, d + 0.01); },
                     {{start_direction, either, "nearly singular"},
                      {{"icd"},
                       either,
                       "C = 0 is at full length, where its matrix is singular to 14 digits: "
                       "rounding decides, and differs between processors"},
                      {strain_limiting, slow, "as Q4"},
                      {everyone, survives, "as Q4"}}});
  }
}

// ---- Rows at full length between pins, and constraints that cannot be met ----

void add_taut(std::vector<HardCase>& cases, const std::vector<double>& limits) {
  const auto row = [](double stretch) {
    return scene_of("taut_row", {{"stretch", stretch}, {"duration", 0.5}});
  };
  // A row of 1 m that is strained by s sags by sqrt(3 s / 8) m.
  const auto taut = [](Trial trial) {
    trial.slack = std::sqrt(3 * trial.strain_limit / 8);
    return trial;
  };
  for (const double limit : limits) {
    cases.push_back({"taut row",
                     "taut_row/" + number_text(limit),
                     "30 links straight between pins, falling; strain limit " + number_text(limit),
                     [=] { return taut(trial_of(row(1), 1.0 / 200, limit)); },
                     {{start_direction, either, "J(x^n) is singular at the start (Q4)"},
                      {current_direction, survives, "the permissible band has an interior"},
                      {everyone, slow, "information travels an edge a sweep"}}});
    cases.push_back({"1 m patch",
                     "patch/" + number_text(limit),
                     "15 x 15 cloth, pinned 1 m apart, falling; strain limit " + number_text(limit),
                     [=] {
                       return taut(trial_of(scene_of("patch", {{"n", 15}, {"duration", 0.5}}),
                                            1.0 / 400, limit));
                     },
                     {{start_direction, either, "J(x^n) is singular at the start (Q4)"},
                      {{"icd"}, either, "at full length no multipliers exist"},
                      {current_direction, survives, "Figure 1 of the paper"},
                      {everyone, slow, "information travels an edge a sweep"}}});
  }
  const std::vector<Expectation> impossible{{springs, survives, "springs stretch"},
                                            {everyone, refuses, "nothing can satisfy it"}};
  cases.push_back({"infeasible", "infeasible/row", "pins 20 % farther apart than the row is long",
                   [=] {
                     Trial trial = trial_of(row(1.2), 1.0 / 100);
                     trial.steps = 3;
                     return trial;
                   },
                   impossible});
  cases.push_back({"infeasible", "infeasible/duplicate", "one edge twice, lengths 1 and 1.1",
                   [] {
                     Mesh mesh = chain(1);
                     join(mesh, 0, 1, 1.1);
                     return trial_of(std::move(mesh), 0.01, 3);
                   },
                   impossible});
  cases.push_back({"triangles",
                   "triangles",
                   "9 x 9 cloth, all edges of its triangles constrained",
                   [=] { return taut(trial_of(cloth(9, true), 1.0 / 400, 100)); },
                   {{everyone, slow, "locked: about 4 n degrees of freedom instead of n^2"}}});
}

// ---- Collapsed and degenerate ----

void add_degenerate(std::vector<HardCase>& cases) {
  const char* row = "degenerate";
  cases.push_back({row,
                   "coincident",
                   "both ends of an edge in one place, falling together",
                   [] {
                     Mesh mesh = chain(3, {1, 0, 0}, false);
                     mesh.start.x.col(2) = mesh.start.x.col(1);
                     mesh.start.x.col(3) = mesh.start.x.col(1) + Eigen::Vector3d(1.0 / 3, 0, 0);
                     return trial_of(std::move(mesh), 0.01, 3);
                   },
                   {{springs, either, "a spring without direction"},
                    {everyone, refuses, "the edge has no direction to grow along"}}});
  cases.push_back({row,
                   "folded",
                   "20 links folded flat onto the first",
                   [] {
                     Mesh mesh = chain(20);
                     for (int i = 0; i <= 20; ++i) mesh.start.x.col(i) << 0.05 * (i % 2), 0, 0;
                     return trial_of(std::move(mesh), 1.0 / 400, 200);
                   },
                   {{start_direction, either, "edges turn by large angles"},
                    {strain_limiting, slow, ""},
                    {everyone, survives, "a chain's J has full rank unless pulled taut"}}});
  cases.push_back({row,
                   "plumb",
                   "all edges parallel: a chain at rest, hanging straight down",
                   [] {
                     return trial_of(chain(20, {0, -1, 0}), 1.0 / 100, 100);
                   },
                   {{everyone, survives, "J has full rank"}}});
  cases.push_back({row,
                   "upright",
                   "a chain standing straight up on its pin",
                   [] {
                     return trial_of(chain(20, {0, 1, 0}), 1.0 / 100, 30);
                   },
                   {{everyone, slow, "an unstable equilibrium"}}});
}

// ---- Mass ratios ----

void add_mass_ratios(std::vector<HardCase>& cases, const std::vector<double>& ratios) {
  for (const double ratio : ratios) {
    const std::vector<Expectation> expected{
        {strain_limiting, slow, "convergence slows with the ratio"},
        {start_direction, either, ""},
        {everyone, survives, "a direct solve does not mind"}};
    cases.push_back({"heavy end", "heavy_end/" + number_text(ratio), "last vertex heavier by this",
                     [ratio] {
                       Mesh mesh = chain(20);
                       mesh.parts.mass.back() *= ratio;
                       return trial_of(std::move(mesh), 1.0 / 400, 40);
                     },
                     expected});
    cases.push_back({"light between heavy",
                     "light_between/" + number_text(ratio),
                     "every other vertex lighter by this",
                     [ratio] {
                       Mesh mesh = chain(20);
                       for (std::size_t i = 1; i < 20; i += 2) mesh.parts.mass[i] /= ratio;
                       Trial trial = trial_of(std::move(mesh), 1.0 / 400, 40);
                       trial.slack = std::sqrt(3 * trial.strain_limit / 8) *
                                     0.1;  // two links between heavy ends
                       return trial;
                     },
                     {{{"icd", "implicit_springs"}, survives, "implicit in the tension"},
                      {everyone, slow,
                       "light beads on a taut string: transverse waves too stiff for a constraint "
                       "direction that is not implicit"}}});
    cases.push_back({"heavy patch",
                     "heavy_patch/" + number_text(ratio),
                     "11 x 11 cloth pinned closer, its middle 3 x 3 heavier by this",
                     [ratio] {
                       Mesh mesh = cloth(11);
                       mesh.parts.pinned = {0};
                       for (int i = 4; i < 7; ++i)
                         for (int j = 4; j < 7; ++j) mesh.parts.mass[as_size(11 * i + j)] *= ratio;
                       return trial_of(std::move(mesh), 1.0 / 400, 40);
                     },
                     {{strain_limiting, slow, "convergence slows with the ratio"},
                      {everyone, either, "rows tighten like ropes around the weight"}}});
  }
}

// ---- Whip ----

void add_whip(std::vector<HardCase>& cases) {
  const char* row = "whip";
  const std::vector<Expectation> hard{{everyone, slow, "large rotations in a step"}};
  cases.push_back({row, "crack", "a folded chain, one end released: the tip outruns gravity",
                   [] {
                     Mesh mesh = chain(40);
                     const double gap = 1e-3;
                     for (int i = 0; i <= 40; ++i)
                       mesh.start.x.col(i) << (i > 20 ? gap * 20 : gap * i),
                           -(i > 20 ? 40 - i : i) / 40.0, 0;
                     for (std::size_t k = 0; k < 40; ++k) {
                       const auto e = static_cast<Eigen::Index>(k);
                       mesh.parts.rest_length[k] =
                           (mesh.start.x.col(e + 1) - mesh.start.x.col(e)).norm();
                     }
                     return trial_of(std::move(mesh), 1.0 / 800, 400);
                   },
                   hard});
  cases.push_back({row,
                   "spin",
                   "a free chain turning at 100 rad/s, 0.1 rad a step",
                   [] {
                     Mesh mesh = chain(20, {1, 0, 0}, false);
                     mesh.parts.gravity.setZero();
                     for (int i = 0; i <= 20; ++i) mesh.start.v(1, i) = 100 * (i / 20.0 - 0.5);
                     return trial_of(std::move(mesh), 1e-3, 200);
                   },
                   {{everyone, either, "nothing outside acts: momentum is conserved"}}});
  cases.push_back({row, "hit", "15 x 15 cloth, its middle vertex hit at 100 m/s",
                   [] {
                     Mesh mesh = cloth(15);
                     mesh.parts.pinned.clear();
                     mesh.start.v(1, 7 * 15 + 7) = 100;
                     Trial trial = trial_of(std::move(mesh), 1e-3, 100);
                     trial.energy_tolerance = closest_point_energy;
                     return trial;
                   },
                   hard});
  cases.push_back({row, "jump", "the pin of a hanging chain jumps by 10 edge lengths in one step",
                   [] {
                     Trial trial = trial_of(chain(20, {0, -1, 0}), 1.0 / 100, 20);
                     trial.disturb = [](State& state, int step) {
                       if (step == 5) state.x(0, 0) += 0.5;
                     };
                     return trial;
                   },
                   hard});
}

// ---- Length ----

void add_lengths(std::vector<HardCase>& cases, const std::vector<double>& links,
                 const std::vector<double>& sides) {
  const auto budget = [](Trial& trial) {  // edge visits that strain limiting may spend on a step
    const double sweeps = std::max(100.0, 2e8 / trial.scene.problem->constraints());
    for (const std::string& name : strain_limiting)
      trial.settings[name] = {{"max_iterations", std::min(1e5, std::floor(sweeps))}};
  };
  for (const double value : links) {
    const int n = static_cast<int>(value);
    cases.push_back({"long chain",
                     "chain/" + std::to_string(n),
                     "this many links, falling, h = 1/400 s",
                     [n, budget] {
                       Trial trial = trial_of(chain(n), 1.0 / 400, 10);
                       budget(trial);
                       return trial;
                     },
                     {{strain_limiting, slow, "information travels an edge a sweep"},
                      {start_direction, slow, "links turn farther in a step the shorter they are"},
                      {everyone, slow, ""}}});
  }
  for (const double value : sides) {
    const int n = static_cast<int>(value);
    cases.push_back({"large cloth",
                     "cloth/" + std::to_string(n),
                     "this many vertices a side, held at one corner, h = 1/400 s",
                     [n, budget] {
                       Mesh mesh = cloth(n);
                       mesh.parts.pinned = {0};
                       Trial trial = trial_of(std::move(mesh), 1.0 / 400, 10);
                       budget(trial);
                       return trial;
                     },
                     {{everyone, slow, ""}}});
  }
}

// ---- Far from the manifold ----

void add_far_starts(std::vector<HardCase>& cases, const std::vector<double>& scales) {
  const std::vector<Expectation> expected{
      {start_direction, either, "no solution along old directions"},
      {strain_limiting, slow, ""},
      {everyone, either, "released energy may be large"}};
  const auto fast = [](Trial trial) {  // the release moves vertices by many edges a step
    trial.energy_tolerance = closest_point_energy;
    return trial;
  };
  for (const double scale : scales) {
    cases.push_back({"far start", "scaled/" + number_text(scale), "a chain of 20 scaled by this",
                     [scale, fast] {
                       Mesh mesh = chain(20);
                       mesh.start.x *= scale;
                       return fast(trial_of(std::move(mesh), 1.0 / 100, 20));
                     },
                     expected});
  }
  cases.push_back({"far start", "noise",
                   "11 x 11 cloth, every vertex displaced by up to 30 % of an edge",
                   [] {
                     Mesh mesh = cloth(11);
                     mesh.parts.pinned = {0};
                     std::mt19937_64 random(7);
                     add_noise(mesh.start.x, mesh.parts.pinned, 0.03, random);
                     return trial_of(std::move(mesh), 1.0 / 100, 20);
                   },
                   expected});
  cases.push_back(
      {"noise every step",
       "drift/chain",
       "every step of a hanging chain starts with errors of up to 10 % of an edge (C10)",
       [] {
         Trial trial = trial_of(chain(20, {0, -1, 0}), 1.0 / 100, 200);
         trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
           add_noise(state.x, {0}, 0.005, *random);
         };
         return trial;
       },
       {{start_direction, either, "directions of a disturbed start"},
        {everyone, survives, "each step begins anew: no drift"}}});
  cases.push_back({"noise every step",
                   "drift/cloth",
                   "the same for an 11 x 11 cloth, 5 % of an edge",
                   [] {
                     Mesh mesh = cloth(11);
                     mesh.parts.pinned = {0};
                     Trial trial = trial_of(std::move(mesh), 1.0 / 100, 50);
                     trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state,
                                                                                     int) {
                       add_noise(state.x, {0}, 0.005, *random);
                     };
                     return trial;
                   },
                   {{everyone, either, ""}}});
}

// ---- Not a number: refused at the door ----

void add_impossible_numbers(std::vector<HardCase>& cases) {
  const auto add = [&](const std::string& name, const std::function<void(Mesh&)>& spoil) {
    cases.push_back({"not a number",
                     "door/" + name,
                     name + " of a vertex or edge",
                     [spoil] {
                       Mesh mesh = chain(4);
                       spoil(mesh);
                       return trial_of(std::move(mesh), 0.01, 3);
                     },
                     {{everyone, refuses, "at the door, naming it"}}});
  };
  for (const double value : {nan, infinity}) {
    add("position " + number_text(value), [value](Mesh& m) { m.start.x(1, 2) = value; });
    add("velocity " + number_text(value), [value](Mesh& m) { m.start.v(0, 3) = value; });
  }
  for (const double value : {nan, infinity, 0.0, -1.0}) {
    add("mass " + number_text(value), [value](Mesh& m) { m.parts.mass[2] = value; });
    add("length " + number_text(value), [value](Mesh& m) { m.parts.rest_length[1] = value; });
  }
}

}  // namespace

HardCaseValues hard_case_values(const std::string& profile) {
  HardCaseValues values{{"distances", {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}},
                        {"limits", {0.01, 0.001}},
                        {"ratios", {1e2, 1e4, 1e6, 1e8}},
                        {"links", {10, 100, 1000}},
                        {"sides", {21}},
                        {"scales", {1.5, 0.5}}};
  if (profile != "quick") {
    values["links"] = {10, 100, 1000, 10000, 100000};
    values["sides"] = {21, 51};
  }
  if (profile == "paper") values["sides"] = {21, 51, 101, 201};
  return values;
}

std::vector<HardCase> hard_cases(const HardCaseValues& values) {
  for (const auto& [name, list] : values) {
    const bool size = name == "links" || name == "sides";
    for (const double value : list) {
      const bool possible = size ? value >= 2 && value <= 1e7 && value == std::floor(value)
                                 : value > 0 && std::isfinite(value) &&
                                       (name != "distances" || value < 1) &&
                                       (name != "limits" || value < 1);
      if (!possible)
        throw UsageError("hard cases: '" + name + "' has " + number_text(value) + ", must be " +
                         (size                                      ? "a whole number from 2 on"
                          : name == "distances" || name == "limits" ? "above 0 and below 1"
                                                                    : "above 0"));
    }
  }
  std::vector<HardCase> cases;
  add_configurations(cases, values.at("distances"));
  add_taut(cases, values.at("limits"));
  add_degenerate(cases);
  add_mass_ratios(cases, values.at("ratios"));
  add_whip(cases);
  add_lengths(cases, values.at("links"), values.at("sides"));
  add_far_starts(cases, values.at("scales"));
  add_impossible_numbers(cases);
  return cases;
}

std::vector<StabilityScene> stability_scenes() {
  const auto scene = [](const char* name, const SceneParameters& given) {
    return [=](double step) { return trial_of(scene_of(name, given), step); };
  };
  return {{"chain of 20", scene("chain", {{"n", 20}}), 0.25, 1.0 / 6400},
          {"drape 11 x 11", scene("drape", {{"n", 11}}), 0.25, 1.0 / 3200},
          {"patch 11 x 11", scene("patch", {{"n", 11}}), 0.25, 1.0 / 3200},
          {"taut row of 30", scene("taut_row", {{"n", 31}}), 0.25, 1.0 / 6400}};
}

std::vector<Freedom> degrees_of_freedom(int n) {
  std::vector<Freedom> list;
  cholmod_common common{};
  cholmod_l_start(&common);
  for (const bool triangles : {false, true}) {
    Mesh mesh = cloth(n, triangles);
    std::mt19937_64 random(1);
    add_noise(mesh.start.x, {}, 0.2 / (n - 1), random);
    const auto rows = mesh.parts.edges.size(), columns = 3 * mesh.parts.mass.size();
    cholmod_triplet* triplet =
        cholmod_l_allocate_triplet(rows, columns, 6 * rows, 0, CHOLMOD_REAL, &common);
    auto* row = static_cast<SuiteSparse_long*>(triplet->i);
    auto* column = static_cast<SuiteSparse_long*>(triplet->j);
    auto* value = static_cast<double*>(triplet->x);
    for (std::size_t k = 0; k < rows; ++k) {
      const auto [a, b] = mesh.parts.edges[k];
      const Eigen::Vector3d u =
          2 * (mesh.start.x.col(b) - mesh.start.x.col(a)) / mesh.parts.rest_length[k];
      for (int axis = 0; axis < 3; ++axis) {
        for (const bool at_b : {false, true}) {
          row[triplet->nnz] = static_cast<SuiteSparse_long>(k);
          column[triplet->nnz] = 3 * (at_b ? b : a) + axis;
          value[triplet->nnz++] = at_b ? u[axis] : -u[axis];
        }
      }
    }
    cholmod_sparse* j = cholmod_l_triplet_to_sparse(triplet, triplet->nnz, &common);
    SuiteSparseQR_factorization<double>* qr =
        SuiteSparseQR_factorize<double>(SPQR_ORDERING_DEFAULT, SPQR_DEFAULT_TOL, j, &common);
    const auto rank = static_cast<int>(qr->rank);
    SuiteSparseQR_free(&qr, &common);
    cholmod_l_free_sparse(&j, &common);
    cholmod_l_free_triplet(&triplet, &common);
    list.push_back(
        {triangles ? "triangles" : "quads", n * n, static_cast<int>(rows), rank, 3 * n * n - rank});
  }
  cholmod_l_finish(&common);
  return list;
}

}  // namespace harness
