// The scenes of the hard cases; configs/hard_cases.json says how they are expected to end.
#include "harness/stability/hard_case.h"

namespace harness::cases {

Draft points(int n, double mass) {
  Draft mesh(n, {{"gravity", g}, {"duration", 0}});
  mesh.parts.mass.assign(n, mass);
  return mesh;
}

Draft chain(int links, const Eigen::Vector3d& direction, bool pinned) {
  Draft mesh =
      vertex_row({{"n", links + 1}, {"length", 1}, {"mass", 1}, {"gravity", g}, {"duration", 0}});
  for (int i = 0; i <= links; ++i) mesh.scene.start.x.col(i) = i * (1.0 / links) * direction;
  if (pinned) mesh.parts.pinned = {0};
  return mesh;
}

Draft cloth(int n, bool diagonals) {
  const double l = 1.0 / (n - 1);
  Draft mesh = points(n * n, 0.2 / (n * n));
  const auto vertex = [n](int i, int j) { return i * n + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.scene.start.x.col(vertex(i, j)) << j * l, 0, i * l;
      if (j + 1 < n) mesh.constrain(vertex(i, j), vertex(i, j + 1), l);
      if (i + 1 < n) mesh.constrain(vertex(i, j), vertex(i + 1, j), l);
      if (diagonals && i + 1 < n && j + 1 < n)
        mesh.constrain(vertex(i, j), vertex(i + 1, j + 1), std::sqrt(2.0) * l);
    }
  mesh.parts.pinned = {vertex(0, 0), vertex(0, n - 1)};
  return mesh;
}

Draft hung_cloth(int n) {
  Draft mesh = cloth(n);
  mesh.parts.pinned = {0};
  return mesh;
}

Draft midpoint_cloth(int n) {
  const Draft corners = cloth(n, true);
  std::map<std::pair<int, int>, int> midpoint_of;
  for (const auto [a, b] : corners.parts.edges)
    midpoint_of.emplace(std::minmax(a, b), static_cast<int>(midpoint_of.size()));
  Draft mesh = points(static_cast<int>(midpoint_of.size()), 0);
  const Positions& x = corners.scene.start.x;
  for (const auto& [ends, v] : midpoint_of)
    mesh.scene.start.x.col(v) = 0.5 * (x.col(ends.first) + x.col(ends.second));
  const double mass = 0.2 / (2 * (n - 1) * (n - 1));  // of a triangle
  const auto add = [&](std::array<int, 3> corner) {
    for (int i = 0; i < 3; ++i) {
      const int a = corner[i], b = corner[(i + 1) % 3], c = corner[(i + 2) % 3];
      const int first = midpoint_of.at(std::minmax(a, b)),
                second = midpoint_of.at(std::minmax(a, c));
      mesh.constrain(first, second, 0.5 * (x.col(b) - x.col(c)).norm());
      mesh.parts.mass[first] += mass / 3;
    }
  };
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int v = i * n + j;  // and the diagonal from it
      add({v, v + 1, v + n + 1});
      add({v, v + n + 1, v + n});
    }
  mesh.parts.pinned = {midpoint_of.at({0, 1}), midpoint_of.at({n - 2, n - 1})};
  return mesh;
}

// Springs promise no limit: a stiffness that would keep it in a fall of a few weights.
Trial trial_of(Scene scene, double step, int steps, double strain_limit) {
  const Problem& problem = *scene.problem;
  return {.scene = scene,
          .step = step,
          .steps = steps > 0 ? steps : static_cast<int>(std::lround(scene.duration / step)),
          .strain_limit = strain_limit,
          .stiffness = 20 * g * problem.total_mass() / strain_limit,
          .slack = strain_limit * problem.longest_rest_length()};
}

Trial trial_of(Draft mesh, double step, int steps, double strain_limit) {
  return trial_of(finished(std::move(mesh)), step, steps, strain_limit);
}

void add_noise(Positions& x, const std::vector<int>& pinned, double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> noise(-size, size);
  const Positions before = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise(random);
  for (const int pin : pinned) x.col(pin) = before.col(pin);
}

}  // namespace harness::cases

namespace harness {
namespace {

using namespace cases;
using inextensible::Positions, inextensible::State;
using Direction = inextensible::Direction;

// An energy_tolerance: the closest point of the manifold is at most twice as far from the start as
// the candidate, so that a velocity filter may return four times its kinetic energy.
constexpr double closest_point_energy = 3;

// ---- Q1 to Q4 (Goldenthal et al. 2007, Figure 2): weightless, one step to given candidates ----

// A power of two, so that the candidates on the singular positions are reached exactly.
constexpr double q_step = 1.0 / 128;
constexpr double q_limit = 5e-7;  // between two distances of the series "Q1 near" to "Q4 near"

Trial one_step(Draft mesh, const Positions& candidate) {
  mesh.parts.gravity.setZero();
  mesh.scene.start.v = (candidate - mesh.scene.start.x) / q_step;
  Trial trial = trial_of(std::move(mesh), q_step, 1, q_limit);
  trial.stiffness = 1e6;
  trial.energy_tolerance = closest_point_energy;
  trial.slack = std::sqrt(2 * q_limit);  // sideways, of an edge pulled taut
  return trial;
}

// An edge of 1 m along x, pinned at the origin; its free end goes to (x, y).
Trial one_edge(double x, double y) {
  Draft mesh = points(2, 1);
  mesh.scene.start.x(0, 1) = 1;
  mesh.parts.pinned = {0};
  mesh.constrain(0, 1, 1);
  Positions candidate = mesh.scene.start.x;
  candidate.col(1) << x, y, 0;
  return one_step(std::move(mesh), candidate);
}

// Two edges of 1 m from pins at (-half_span, 0) and (half_span, 0) to a vertex between them that
// goes from (0, y) to (0, candidate_y).
Trial two_edges(double half_span, double y, double candidate_y) {
  Draft mesh = points(3, 1);
  mesh.scene.start.x.col(0) << -half_span, 0, 0;
  mesh.scene.start.x.col(1) << 0, y, 0;
  mesh.scene.start.x.col(2) << half_span, 0, 0;
  mesh.parts.pinned = {0, 2};
  mesh.constrain(0, 1, 1);
  mesh.constrain(1, 2, 1);
  Positions candidate = mesh.scene.start.x;
  candidate(1, 1) = candidate_y;
  return one_step(std::move(mesh), candidate);
}

// ---- Rows at full length between pins, and constraints that cannot be met ----

// A row of 1 m that is strained by s sags by sqrt(3 s / 8) m.
Trial taut(Trial trial) {
  trial.slack = std::sqrt(3 * trial.strain_limit / 8);
  return trial;
}

Trial duplicate_edge(double /*value*/) {
  Draft mesh = chain(1);
  mesh.constrain(0, 1, 1.1);
  return trial_of(std::move(mesh), 0.01, 3);
}

// ---- Collapsed and degenerate starts ----

Trial coincident(double /*value*/) {
  Draft mesh = chain(3, along, false);
  mesh.scene.start.x.col(2) = mesh.scene.start.x.col(1);
  mesh.scene.start.x.col(3) = mesh.scene.start.x.col(1) + Eigen::Vector3d(1.0 / 3, 0, 0);
  return trial_of(std::move(mesh), 0.01, 3);
}

Trial folded(double /*value*/) {
  Draft mesh = chain(20);
  for (int i = 0; i <= 20; ++i) mesh.scene.start.x.col(i) << 0.05 * (i % 2), 0, 0;
  return trial_of(std::move(mesh), 1.0 / 400, 200);
}

// ---- Masses of unlike vertices ----

Trial heavy_end(double ratio) {
  Draft mesh = chain(20);
  mesh.parts.mass.back() *= ratio;
  return trial_of(std::move(mesh), 1.0 / 400, 40);
}

// The same kind of chain swings three times from horizontal, at the step of a game.
Trial heavy_swing(double /*value*/) {
  Draft mesh = chain(20);
  mesh.parts.mass.back() *= 100;
  Trial trial = trial_of(std::move(mesh), 1.0 / 60, 180);
  trial.stiffness = 1e5;
  trial.slack = 2 * trial.strain_limit;  // m, of a chain of 1 m between both ends of the band
  return trial;
}

Trial light_between(double ratio) {
  Draft mesh = chain(20);
  for (std::size_t i = 1; i < 20; i += 2) mesh.parts.mass[i] /= ratio;
  Trial trial = trial_of(std::move(mesh), 1.0 / 400, 40);
  trial.slack = std::sqrt(3 * trial.strain_limit / 8) * 0.1;  // two links between heavy ends
  return trial;
}

Trial heavy_patch(double ratio) {
  Draft mesh = hung_cloth(11);
  for (int i = 4; i < 7; ++i)
    for (int j = 4; j < 7; ++j) mesh.parts.mass[11 * i + j] *= ratio;
  return trial_of(std::move(mesh), 1.0 / 400, 40);
}

// ---- Large rotations and velocities in one step ----

// The chain hangs down for half of its length and comes up again.
Trial crack(double /*value*/) {
  Draft mesh = chain(40);
  const double gap = 1e-3;
  for (int i = 0; i <= 40; ++i)
    mesh.scene.start.x.col(i) << (i > 20 ? gap * 20 : gap * i), -(i > 20 ? 40 - i : i) / 40.0, 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    mesh.parts.rest_length[k] = (mesh.scene.start.x.col(e + 1) - mesh.scene.start.x.col(e)).norm();
  }
  return trial_of(std::move(mesh), 1.0 / 800, 400);
}

Trial spin(double /*value*/) {
  Draft mesh = chain(20, along, false);
  mesh.parts.gravity.setZero();
  for (int i = 0; i <= 20; ++i) mesh.scene.start.v(1, i) = 100 * (i / 20.0 - 0.5);
  return trial_of(std::move(mesh), 1e-3, 200);
}

Trial hit(double /*value*/) {
  Draft mesh = cloth(15);
  mesh.parts.pinned.clear();
  mesh.scene.start.v(1, 7 * 15 + 7) = 100;
  Trial trial = trial_of(std::move(mesh), 1e-3, 100);
  trial.energy_tolerance = closest_point_energy;
  return trial;
}

Trial jump(double /*value*/) {
  Trial trial = trial_of(chain(20, down), 1.0 / 100, 20);
  trial.disturb = [](State& state, int step) {
    if (step == 5) state.x(0, 0) += 0.5;
  };
  return trial;
}

// Ten steps, with a budget of edge visits for passes and of iterations for projections.
Trial with_budget(Draft mesh) {
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

// 11 x 11 vertices (edges are 2/5 of the radius), until the cloth lies on the ball and hangs.
Trial on_a_ball(const char* parameter, double value, double speed = 0, double depth = 0) {
  Scene scene = built_scene("drape", {{"n", 11}, {parameter, value}});
  if (speed > 0) scene.start.v.row(1).setConstant(-speed);
  if (depth > 0) scene.start.x.row(1).array() -= depth;
  Trial trial = trial_of(std::move(scene), 1.0 / 200, 40);
  if (depth > 0) trial.energy_tolerance = -1;  // it is thrown out
  return trial;
}

// ---- Starts far from the manifold, and whether errors pile up over steps ----

Trial scaled(double scale) {
  Draft mesh = chain(20);
  mesh.scene.start.x *= scale;
  Trial trial = trial_of(std::move(mesh), 1.0 / 100, 20);
  trial.energy_tolerance = closest_point_energy;  // the release moves vertices by many edges a step
  return trial;
}

Trial noise(double /*value*/) {
  Draft mesh = hung_cloth(11);
  std::mt19937_64 random(7);
  add_noise(mesh.scene.start.x, mesh.parts.pinned, 0.03, random);
  return trial_of(std::move(mesh), 1.0 / 100, 20);
}

Trial ten_seconds(Draft mesh) { return trial_of(std::move(mesh), 1.0 / 100, 1000); }

Trial with_noise_every_step(Trial trial) {
  trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
    add_noise(state.x, {0}, 0.005, *random);
  };
  return trial;
}

// How cases are built: one by its name, a series by its row, with a value of its list.
const std::map<std::string, Trial (*)(double value)> builders{
    {"Q1", [](double) { return one_edge(0, 2); }},
    {"Q2", [](double) { return one_edge(0, 0.5); }},
    {"Q3", [](double) { return two_edges(0.6, 0.8, 0); }},
    {"Q4", [](double) { return two_edges(1, 0, 0.01); }},
    {"infeasible/row",
     [](double) {
       return trial_of(built_scene("taut_row", {{"stretch", 1.2}}), 1.0 / 100, 3);
     }},
    {"infeasible/duplicate", duplicate_edge},
    {"triangles", [](double) { return taut(trial_of(cloth(9, true), 1.0 / 400, 100)); }},
    {"triangles/midpoints",
     [](double) { return taut(trial_of(midpoint_cloth(9), 1.0 / 400, 100)); }},
    {"coincident", coincident},
    {"folded", folded},
    {"plumb", [](double) { return trial_of(chain(20, down), 1.0 / 100, 100); }},
    {"upright", [](double) { return trial_of(chain(20, up), 1.0 / 100, 30); }},
    {"crack", crack},
    {"spin", spin},
    {"hit", hit},
    {"jump", jump},
    {"contact/smooth", [](double) { return on_a_ball("friction", 0); }},
    {"contact/sticky", [](double) { return on_a_ball("friction", 10); }},
    {"contact/corners", [](double) { return on_a_ball("subdivisions", 0); }},
    {"contact/fast", [](double) { return on_a_ball("n", 11, 5); }},
    {"contact/inside", [](double) { return on_a_ball("n", 11, 0, 0.021); }},
    {"noise", noise},
    {"drift/chain", [](double) { return with_noise_every_step(ten_seconds(chain(20, down))); }},
    {"drift/cloth", [](double) { return with_noise_every_step(ten_seconds(hung_cloth(11))); }},
    {"swing/chain", [](double) { return ten_seconds(chain(20)); }},
    {"swing/cloth", [](double) { return ten_seconds(hung_cloth(11)); }},
    {"Q1 near", [](double d) { return one_edge(0, 1 + d); }},
    {"Q2 near", [](double d) { return one_edge(d, 0.5); }},
    {"Q3 near", [](double d) { return two_edges(0.6, 0.8, 0.8 * d); }},
    {"Q4 near", [](double d) { return two_edges(std::sqrt(1 - d * d), d, d + 0.01); }},
    {"taut row",
     [](double limit) {
       return taut(trial_of(built_scene("taut_row", {{"duration", 0.5}}), 1.0 / 200, 0, limit));
     }},
    {"1 m patch",
     [](double limit) {
       return taut(
           trial_of(built_scene("patch", {{"n", 15}, {"duration", 0.5}}), 1.0 / 400, 0, limit));
     }},
    {"heavy end", heavy_end},
    {"heavy_swing", heavy_swing},
    {"light between heavy", light_between},
    {"heavy patch", heavy_patch},
    {"long chain", [](double n) { return with_budget(chain(static_cast<int>(n))); }},
    {"large cloth", [](double n) { return with_budget(hung_cloth(static_cast<int>(n))); }},
    {"far start", scaled}};

// Numbers that are not finite or are physically impossible: refused at the door.
struct Impossible {
  const char* what;
  bool state;  // of a state, where any finite number is possible
  void (*put)(Draft&, double);
};
constexpr Impossible impossible_numbers[] = {
    {"position", true, [](Draft& m, double v) { m.scene.start.x(1, 2) = v; }},
    {"velocity", true, [](Draft& m, double v) { m.scene.start.v(0, 3) = v; }},
    {"mass", false, [](Draft& m, double v) { m.parts.mass[2] = v; }},
    {"length", false, [](Draft& m, double v) { m.parts.rest_length[1] = v; }}};

}  // namespace

std::map<std::string, std::vector<double>> hard_case_values(const std::string& profile) {
  const nlohmann::json& values = hard_cases_document().at("values");
  std::vector<std::string> profiles;
  for (const auto& [name, own] : values.items()) profiles.push_back(name);
  check_known("profile of hard cases", profile, profiles);
  return values.at(profile);
}

std::vector<HardCase> hard_cases(const std::string& profile) {
  const auto values = hard_case_values(profile);
  std::vector<HardCase> all;
  for (const nlohmann::json& entry : hard_cases_document().at("cases")) {
    const std::string name = entry.at("name"), row = entry.at("row"), what = entry.at("what"),
                      over = entry.value("over", ""), key = over.empty() ? name : row;
    const auto found = builders.find(key);
    if (found == builders.end())
      throw UsageError("hard cases: nothing in harness/stability/hard_cases.cpp builds '" + key +
                       "'");
    for (const double value : over.empty() ? std::vector{unknown} : values.at(over))
      all.push_back({row, over.empty() ? name : name + "/" + number_text(value), what,
                     [build = found->second, value] { return build(value); }, value});
  }
  for (const auto& [what, state, put] : impossible_numbers)
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 0.0, -1.0}) {
      if (state && std::isfinite(value)) continue;
      const std::string name = std::string(what) + " " + number_text(value);
      all.push_back({"not a number", "door/" + name, name + " of a vertex or edge", [=, put = put] {
                       Draft mesh = chain(4);
                       put(mesh, value);
                       return trial_of(std::move(mesh), 0.01, 3);
                     }});
    }
  add_expectations(all);
  return all;
}

}  // namespace harness
