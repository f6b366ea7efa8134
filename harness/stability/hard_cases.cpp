// The hard cases: their scenes. How they are expected to end is in configs/hard_cases.json.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/stability/cases.h"
#include "harness/stability/hard_case.h"

namespace harness {
namespace {

using namespace cases;
using inextensible::Positions;
using inextensible::State;
using Direction = inextensible::Direction;

// The closest point of the manifold is at most twice as far from the start as the candidate is, so
// that a velocity filter may return up to four times the candidate's kinetic energy: an
// energy_tolerance.
constexpr double closest_point_energy = 3;

// ---- Q1 to Q4 (Goldenthal et al. 2007, Figure 2): weightless, one step to given candidates ----

// A power of two, so that the candidates on the singular positions are reached exactly.
constexpr double q_step = 1.0 / 128;
constexpr double q_limit = 5e-7;  // between two of the distances that hard_case_values() has

Trial one_step(Mesh mesh, const Positions& candidate) {
  mesh.parts.gravity.setZero();
  mesh.start.v = (candidate - mesh.start.x) / q_step;
  Trial trial = trial_of(std::move(mesh), q_step, 1, q_limit);
  trial.stiffness = 1e6;
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

// ---- Rows at full length between pins, and constraints that cannot be met ----

Scene row_of_links(double stretch) {
  return scene_of("taut_row", {{"stretch", stretch}, {"duration", 0.5}});
}

// A row of 1 m that is strained by s sags by sqrt(3 s / 8) m.
Trial taut(Trial trial) {
  trial.slack = std::sqrt(3 * trial.strain_limit / 8);
  return trial;
}

Trial duplicate_edge() {
  Mesh mesh = chain(1);
  join(mesh, 0, 1, 1.1);
  return trial_of(std::move(mesh), 0.01, 3);
}

// ---- Collapsed and degenerate starts ----

Trial coincident() {
  Mesh mesh = chain(3, along, false);
  mesh.start.x.col(2) = mesh.start.x.col(1);
  mesh.start.x.col(3) = mesh.start.x.col(1) + Eigen::Vector3d(1.0 / 3, 0, 0);
  return trial_of(std::move(mesh), 0.01, 3);
}

Trial folded() {
  Mesh mesh = chain(20);
  for (int i = 0; i <= 20; ++i) mesh.start.x.col(i) << 0.05 * (i % 2), 0, 0;
  return trial_of(std::move(mesh), 1.0 / 400, 200);
}

// ---- Masses of unlike vertices ----

Trial heavy_end(double ratio) {
  Mesh mesh = chain(20);
  mesh.parts.mass.back() *= ratio;
  return trial_of(std::move(mesh), 1.0 / 400, 40);
}

Trial light_between(double ratio) {
  Mesh mesh = chain(20);
  for (std::size_t i = 1; i < 20; i += 2) mesh.parts.mass[i] /= ratio;
  Trial trial = trial_of(std::move(mesh), 1.0 / 400, 40);
  trial.slack = std::sqrt(3 * trial.strain_limit / 8) * 0.1;  // two links between heavy ends
  return trial;
}

Trial heavy_patch(double ratio) {
  Mesh mesh = hung_cloth(11);
  for (int i = 4; i < 7; ++i)
    for (int j = 4; j < 7; ++j) mesh.parts.mass[11 * i + j] *= ratio;
  return trial_of(std::move(mesh), 1.0 / 400, 40);
}

// ---- Large rotations and velocities in one step ----

// Hangs down by half of its length and goes up again.
Trial crack() {
  Mesh mesh = chain(40);
  const double gap = 1e-3;
  for (int i = 0; i <= 40; ++i)
    mesh.start.x.col(i) << (i > 20 ? gap * 20 : gap * i), -(i > 20 ? 40 - i : i) / 40.0, 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    mesh.parts.rest_length[k] = (mesh.start.x.col(e + 1) - mesh.start.x.col(e)).norm();
  }
  return trial_of(std::move(mesh), 1.0 / 800, 400);
}

Trial spin() {
  Mesh mesh = chain(20, along, false);
  mesh.parts.gravity.setZero();
  for (int i = 0; i <= 20; ++i) mesh.start.v(1, i) = 100 * (i / 20.0 - 0.5);
  return trial_of(std::move(mesh), 1e-3, 200);
}

Trial hit() {
  Mesh mesh = cloth(15);
  mesh.parts.pinned.clear();
  mesh.start.v(1, 7 * 15 + 7) = 100;
  Trial trial = trial_of(std::move(mesh), 1e-3, 100);
  trial.energy_tolerance = closest_point_energy;
  return trial;
}

Trial jump() {
  Trial trial = trial_of(chain(20, down), 1.0 / 100, 20);
  trial.disturb = [](State& state, int step) {
    if (step == 5) state.x(0, 0) += 0.5;
  };
  return trial;
}

// ---- Long chains and large cloths ----

// Ten steps, with a budget of edge visits that passes may spend on a step, and of iterations of
// projections.
Trial with_budget(Mesh mesh) {
  Trial trial = trial_of(std::move(mesh), 1.0 / 400, 10);
  const double passes = std::max(100.0, 2e8 / trial.scene.problem->constraints());
  for (const auto& backend : inextensible::backends()) {
    if (!inextensible::is_built_in(backend.name) ||
        backend.strain_control != inextensible::StrainControl::strain_limit)
      continue;
    const std::string method = backend.method;
    if (backend.direction == Direction::local || method == "augmented_vbd" || method == "admm")
      trial.settings[backend.name] = {{"max_iterations", std::min(1e5, std::floor(passes))}};
    if (backend.direction == Direction::current)
      trial.settings[backend.name] = {{"max_iterations", 200.0}};
  }
  return trial;
}

// ---- Cloth on a ball, with contact inside the solve ----

// 11 x 11 vertices, so that edges are two fifths of the ball's radius; until the cloth lies on the
// ball, and its sides hang.
Trial on_a_ball(const char* parameter, double value, double speed = 0, double depth = 0) {
  Scene scene = scene_of("drape", {{"n", 11}, {parameter, value}});
  if (speed > 0) scene.start.v.row(1).setConstant(-speed);
  if (depth > 0) scene.start.x.row(1).array() -= depth;
  Trial trial = trial_of(std::move(scene), 1.0 / 200, 40);
  if (depth > 0) trial.energy_tolerance = -1;  // it is thrown out
  return trial;
}

// ---- Starts far from the manifold, and whether errors pile up over steps ----

Trial scaled(double scale) {
  Mesh mesh = chain(20);
  mesh.start.x *= scale;
  Trial trial = trial_of(std::move(mesh), 1.0 / 100, 20);
  trial.energy_tolerance = closest_point_energy;  // the release moves vertices by many edges a step
  return trial;
}

Trial noise() {
  Mesh mesh = hung_cloth(11);
  std::mt19937_64 random(7);
  add_noise(mesh.start.x, mesh.parts.pinned, 0.03, random);
  return trial_of(std::move(mesh), 1.0 / 100, 20);
}

Trial ten_seconds(Mesh mesh) { return trial_of(std::move(mesh), 1.0 / 100, 1000); }

Trial with_noise_every_step(Trial trial) {
  trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
    add_noise(state.x, {0}, 0.005, *random);
  };
  return trial;
}

// ---- All of them ----

std::vector<HardCase> fixed_cases() {
  const auto taut_cloth = [](Mesh mesh) { return taut(trial_of(std::move(mesh), 1.0 / 400, 100)); };
  return {
      {"Q1", "Q1", "an edge turns by 90 degrees and doubles its length",
       [] { return one_edge(0, 2); }},
      {"Q2", "Q2", "an edge turns by 90 degrees: J(x0) W J(x^n)^T = 0",
       [] { return one_edge(0, 0.5); }},
      {"Q3", "Q3", "two edges made parallel by the step: J(x0) is rank deficient",
       [] { return two_edges(0.6, 0.8, 0); }},
      {"Q4", "Q4", "a straight chain between two pins: J(x^n) is rank deficient",
       [] { return two_edges(1, 0, 0.01); }},
      {"infeasible", "infeasible/row", "pins 20 % farther apart than the row is long",
       [] { return trial_of(row_of_links(1.2), 1.0 / 100, 3); }},
      {"infeasible", "infeasible/duplicate", "one edge twice, lengths 1 and 1.1", duplicate_edge},
      {"triangles", "triangles", "9 x 9 cloth, all edges of its triangles constrained",
       [=] { return taut_cloth(cloth(9, true)); }},
      {"triangles", "triangles/midpoints",
       "the same triangles, constrained between the midpoints of their edges",
       [=] { return taut_cloth(midpoint_cloth(9)); }},
      {"degenerate", "coincident", "both ends of an edge in one place, falling together",
       coincident},
      {"degenerate", "folded", "20 links folded flat onto the first", folded},
      {"degenerate", "plumb", "all edges parallel: a chain at rest, hanging straight down",
       [] { return trial_of(chain(20, down), 1.0 / 100, 100); }},
      {"degenerate", "upright", "a chain standing straight up on its pin",
       [] { return trial_of(chain(20, up), 1.0 / 100, 30); }},
      {"whip", "crack", "a folded chain, one end released: the tip outruns gravity", crack},
      {"whip", "spin", "a free chain turning at 100 rad/s, 0.1 rad a step", spin},
      {"whip", "hit", "15 x 15 cloth, its middle vertex hit at 100 m/s", hit},
      {"whip", "jump", "the pin of a hanging chain jumps by 10 edge lengths in one step", jump},
      {"contact", "contact/smooth", "11 x 11 cloth falls onto a ball without friction",
       [] { return on_a_ball("friction", 0); }},
      {"contact", "contact/sticky",
       "the same with friction 10: what has touched the ball stays there",
       [] { return on_a_ball("friction", 10); }},
      {"contact", "contact/corners", "the same on an icosahedron of 20 faces",
       [] { return on_a_ball("subdivisions", 0); }},
      {"contact", "contact/fast", "the same at 5 m/s, a quarter of an edge in a step",
       [] { return on_a_ball("n", 11, 5); }},
      {"contact", "contact/inside", "the same from a start 2 cm inside the ball",
       [] { return on_a_ball("n", 11, 0, 0.021); }},
      {"far start", "noise", "11 x 11 cloth, every vertex displaced by up to 30 % of an edge",
       noise},
      {"noise every step", "drift/chain",
       "every step of a hanging chain starts with errors of up to 10 % of an edge (C10)",
       [] { return with_noise_every_step(ten_seconds(chain(20, down))); }},
      {"noise every step", "drift/cloth", "the same for an 11 x 11 cloth, 5 % of an edge",
       [] { return with_noise_every_step(ten_seconds(hung_cloth(11))); }},
      {"ten seconds", "swing/chain", "a chain of 20 swings for 10 s, h = 1/100 s (C10)",
       [] { return ten_seconds(chain(20)); }},
      {"ten seconds", "swing/cloth",
       "an 11 x 11 cloth held at one corner swings for 10 s, h = 1/100 s",
       [] { return ten_seconds(hung_cloth(11)); }},
  };
}

// A case for each value of a list.
struct Series {
  const char *values, *row, *name, *what;
  Trial (*build)(double value);
};
constexpr Series case_series[] = {
    {"distances", "Q1 near", "Q1", "the candidate too long by this much only",
     [](double d) { return one_edge(0, 1 + d); }},
    {"distances", "Q2 near", "Q2", "J(x0) W J(x^n)^T of this size",
     [](double d) { return one_edge(d, 0.5); }},
    {"distances", "Q3 near", "Q3", "the candidate beside the line of the pins",
     [](double d) { return two_edges(0.6, 0.8, 0.8 * d); }},
    {"distances", "Q4 near", "Q4", "a sagging chain between two pins",
     [](double d) { return two_edges(std::sqrt(1 - d * d), d, d + 0.01); }},
    {"limits", "taut row", "taut_row", "30 links straight between pins, falling; this strain limit",
     [](double limit) { return taut(trial_of(row_of_links(1), 1.0 / 200, 0, limit)); }},
    {"limits", "1 m patch", "patch", "15 x 15 cloth, pinned 1 m apart, falling; this strain limit",
     [](double limit) {
       return taut(
           trial_of(scene_of("patch", {{"n", 15}, {"duration", 0.5}}), 1.0 / 400, 0, limit));
     }},
    {"ratios", "heavy end", "heavy_end", "last vertex heavier by this", heavy_end},
    {"ratios", "light between heavy", "light_between", "every other vertex lighter by this",
     light_between},
    {"ratios", "heavy patch", "heavy_patch",
     "11 x 11 cloth pinned closer, its middle 3 x 3 heavier by this", heavy_patch},
    {"links", "long chain", "chain", "this many links, falling, h = 1/400 s",
     [](double n) { return with_budget(chain(static_cast<int>(n))); }},
    {"sides", "large cloth", "cloth", "this many vertices a side, held at one corner, h = 1/400 s",
     [](double n) { return with_budget(hung_cloth(static_cast<int>(n))); }},
    {"scales", "far start", "scaled", "a chain of 20 scaled by this", scaled},
};

// Numbers that are none, or impossible ones: refused at the door.
struct Impossible {
  const char* what;
  bool state;  // any number but NaN and infinity would be possible
  void (*put)(Mesh&, double);
};
constexpr Impossible impossible_numbers[] = {
    {"position", true, [](Mesh& m, double v) { m.start.x(1, 2) = v; }},
    {"velocity", true, [](Mesh& m, double v) { m.start.v(0, 3) = v; }},
    {"mass", false, [](Mesh& m, double v) { m.parts.mass[2] = v; }},
    {"length", false, [](Mesh& m, double v) { m.parts.rest_length[1] = v; }},
};

void check_value(const std::string& name, double value) {
  const bool size = name == "links" || name == "sides",
             fraction = name == "distances" || name == "limits";
  const bool possible = size ? value >= 2 && value <= 1e7 && value == std::floor(value)
                             : value > 0 && value < (fraction ? 1.0 : HUGE_VAL);
  if (!possible)
    throw UsageError("hard cases: '" + name + "' has " + number_text(value) + ", must be " +
                     (size       ? "a whole number from 2 on"
                      : fraction ? "above 0 and below 1"
                                 : "above 0"));
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
  std::vector<HardCase> all = fixed_cases();
  for (const Series& one : case_series) {
    for (const double value : values.at(one.values)) {
      check_value(one.values, value);
      all.push_back({one.row, std::string(one.name) + "/" + number_text(value), one.what,
                     [build = one.build, value] { return build(value); }, value});
    }
  }
  for (const auto& [what, state, put] : impossible_numbers) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 0.0, -1.0}) {
      if (state && std::isfinite(value)) continue;
      const std::string name = std::string(what) + " " + number_text(value);
      all.push_back({"not a number", "door/" + name, name + " of a vertex or edge", [=, put = put] {
                       Mesh mesh = chain(4);
                       put(mesh, value);
                       return trial_of(std::move(mesh), 0.01, 3);
                     }});
    }
  }
  add_expectations(all);
  return all;
}

}  // namespace harness
