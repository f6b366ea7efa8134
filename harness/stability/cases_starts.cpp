// Starts and events that are hard in themselves: no positions within the limit, edges without
// length, large velocities, starts far from the manifold of inextensible positions, numbers that
// are none.
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "harness/base/text.h"
#include "harness/stability/cases.h"

namespace harness::cases {

using inextensible::State;

// ---- Rows at full length between pins, and constraints that cannot be met ----

namespace {

// A row of n links that sags within the strain limit s has slopes of about (6 s)^1/2; its slowest
// mode shrinks by (6 s) (pi / n)^2 a pass: e-fold in 1500 passes at 1 %, ten times as many at 0.1
// %.
Expectation passes_along_a_row(double limit) {
  if (limit > 0.005)
    return survive(strain_limiting, "about 1e4 passes a step, where 1e5 are allowed");
  return refuse(strain_limiting,
                "about 1e5 passes a step, as many as are allowed, and one step of many may take "
                "more")
      .or_else(survives, "the estimate is one of order: averaged and over-relaxed passes reach it");
}

Scene row_of_links(double stretch) {
  return scene_of("taut_row", {{"stretch", stretch}, {"duration", 0.5}});
}

// A row of 1 m that is strained by s sags by sqrt(3 s / 8) m.
Trial taut(Trial trial) {
  trial.slack = std::sqrt(3 * trial.strain_limit / 8);
  return trial;
}

const Expectation band{
    survive(everyone, "springs stretch, and the permissible band has an interior")};

void add_between_pins(Cases& cases, double limit) {
  const std::vector<Expectation> expected{
      refuse(start_direction,
             "J(x^n) is singular at the start (Q4), and where the fall is stopped its directions "
             "lie along the row, the correction across it"),
      survive(end_direction, "the permissible band has an interior")
          .or_else(refuses,
                   "at full length no multipliers exist: whether the band ends the iteration "
                   "before depends on the path of Newton's steps"),
      survive(current_direction,
              "the permissible band has an interior, which damped projections find"),
      passes_along_a_row(limit), band};
  const std::string value = number_text(limit);
  cases.add(
      "taut row", "taut_row/" + value,
      "30 links straight between pins, falling; strain limit " + value,
      [=] { return taut(trial_of(row_of_links(1), 1.0 / 200, 0, limit)); }, expected);
  cases.add(
      "1 m patch", "patch/" + value,
      "15 x 15 cloth, pinned 1 m apart, falling; strain limit " + value,
      [=] {
        Scene patch = scene_of("patch", {{"n", 15}, {"duration", 0.5}});
        return taut(trial_of(std::move(patch), 1.0 / 400, 0, limit));
      },
      expected);
}

}  // namespace

void add_taut(Cases& cases) {
  for (const double limit : cases.values.at("limits")) add_between_pins(cases, limit);
  const std::vector<Expectation> impossible{survive(springs, "springs stretch"),
                                            refuse(everyone, "nothing can satisfy it")};
  cases.add(
      "infeasible", "infeasible/row", "pins 20 % farther apart than the row is long",
      [] { return trial_of(row_of_links(1.2), 1.0 / 100, 3); }, impossible);
  cases.add(
      "infeasible", "infeasible/duplicate", "one edge twice, lengths 1 and 1.1",
      [] {
        Mesh mesh = chain(1);
        join(mesh, 0, 1, 1.1);
        return trial_of(std::move(mesh), 0.01, 3);
      },
      impossible);
  cases.add(
      "triangles", "triangles", "9 x 9 cloth, all edges of its triangles constrained",
      [] { return taut(trial_of(cloth(9, true), 1.0 / 400, 100)); },
      {refuse(start_direction,
              "flat, more edges than coordinates in the plane: J(x^n) is rank deficient"),
       refuse(end_direction, "locked: no multipliers exist at C = 0, and Newton aims there")
           .or_else(survives, "the permissible band may end the iteration before"),
       survive(current_direction,
               "locked, but the permissible band has an interior, which damped projections find"),
       passes_along_a_row(0.01), band});
  cases.add("triangles", "triangles/midpoints",
            "the same triangles, constrained between the midpoints of their edges",
            [] { return taut(trial_of(midpoint_cloth(9), 1.0 / 400, 100)); },
            {survive(everyone, "a hinge in each midpoint: nothing locks")});
}

// ---- Collapsed and degenerate starts ----

void add_degenerate(Cases& cases) {
  const char *row = "degenerate", *no_direction = "the edge has no direction to grow along";
  cases.add(row, "coincident", "both ends of an edge in one place, falling together",
            [] {
              Mesh mesh = chain(3, along, false);
              mesh.start.x.col(2) = mesh.start.x.col(1);
              mesh.start.x.col(3) = mesh.start.x.col(1) + Eigen::Vector3d(1.0 / 3, 0, 0);
              return trial_of(std::move(mesh), 0.01, 3);
            },
            {survive(springs, "a spring without direction pulls nowhere, and nothing else does"),
             refuse({"admm"}, no_direction)
                 .or_else(survives,
                          "the linear system may part its ends by a rounding, and any direction is "
                          "brought to full length at once"),
             refuse(everyone, no_direction)});
  cases.add(
      row, "folded", "20 links folded flat onto the first",
      [] {
        Mesh mesh = chain(20);
        for (int i = 0; i <= 20; ++i) mesh.start.x.col(i) << 0.05 * (i % 2), 0, 0;
        return trial_of(std::move(mesh), 1.0 / 400, 200);
      },
      {survive(start_direction, "links unfold at 100 rad/s at most, a quarter of a radian a step"),
       survive(strain_limiting, "20 links: some hundred passes"),
       survive(everyone, "a chain's J has full rank unless pulled taut")});
  cases.add(row, "plumb", "all edges parallel: a chain at rest, hanging straight down",
            [] { return trial_of(chain(20, down), 1.0 / 100, 100); },
            {survive(everyone, "J has full rank")});
  cases.add(row, "upright", "a chain standing straight up on its pin",
            [] { return trial_of(chain(20, up), 1.0 / 100, 30); },
            {survive(everyone,
                     "an unstable equilibrium, but J has full rank, and in 0.3 s rounding does "
                     "not grow to anything")});
}

// ---- Large rotations and velocities in one step ----

namespace {

// Hangs down by half of its length and goes up again.
Mesh folded_chain() {
  Mesh mesh = chain(40);
  const double gap = 1e-3;
  for (int i = 0; i <= 40; ++i)
    mesh.start.x.col(i) << (i > 20 ? gap * 20 : gap * i), -(i > 20 ? 40 - i : i) / 40.0, 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    mesh.parts.rest_length[k] = (mesh.start.x.col(e + 1) - mesh.start.x.col(e)).norm();
  }
  return mesh;
}

}  // namespace

void add_whip(Cases& cases) {
  const Expectation others =
      survive(everyone, "each edge keeps its own direction, however far it turns");
  cases.add("whip", "crack", "a folded chain, one end released: the tip outruns gravity",
            [] { return trial_of(folded_chain(), 1.0 / 800, 400); },
            {refuse(start_direction,
                    "the last link of 25 mm turns over within two steps: more than 60 degrees in "
                    "one, where no multiple of the old direction reaches its length"),
             others});
  cases.add("whip", "spin", "a free chain turning at 100 rad/s, 0.1 rad a step",
            [] {
              Mesh mesh = chain(20, along, false);
              mesh.parts.gravity.setZero();
              for (int i = 0; i <= 20; ++i) mesh.start.v(1, i) = 100 * (i / 20.0 - 0.5);
              return trial_of(std::move(mesh), 1e-3, 200);
            },
            {survive(everyone,
                     "0.1 rad in a step is little, and nothing outside acts: momentum is "
                     "conserved")});
  cases.add("whip", "hit", "15 x 15 cloth, its middle vertex hit at 100 m/s",
            [] {
              Mesh mesh = cloth(15);
              mesh.parts.pinned.clear();
              mesh.start.v(1, 7 * 15 + 7) = 100;
              Trial trial = trial_of(std::move(mesh), 1e-3, 100);
              trial.energy_tolerance = closest_point_energy;
              return trial;
            },
            {refuse(start_direction,
                    "the vertex is 0.1 m above the others, edges are 0.07 m long, and all old "
                    "directions are horizontal (Q1)"),
             others});
  cases.add("whip", "jump", "the pin of a hanging chain jumps by 10 edge lengths in one step",
            [] {
              Trial trial = trial_of(chain(20, down), 1.0 / 100, 20);
              trial.disturb = [](State& state, int step) {
                if (step == 5) state.x(0, 0) += 0.5;
              };
              return trial;
            },
            {refuse(start_direction,
                    "the chain must move sideways by ten edges, and all old directions but one "
                    "are plumb (Q1)"),
             others});
}

// ---- Starts far from the manifold, and whether errors pile up over steps ----

namespace {

Trial ten_seconds(Mesh mesh) { return trial_of(std::move(mesh), 1.0 / 100, 1000); }

Trial with_noise_every_step(Trial trial) {
  trial.disturb = [random = std::make_shared<std::mt19937_64>(7)](State& state, int) {
    add_noise(state.x, {0}, 0.005, *random);
  };
  return trial;
}

}  // namespace

void add_far_starts(Cases& cases) {
  // The release throws the ends at 50 m/s past the places where they belong, and back again.
  const char *thrown =
                 "the release throws the chain through itself: what it looks like after a few "
                 "steps follows from how gravity buckles it, which amplifies rounding",
             *close = "close to any position there are permissible ones";
  for (const double scale : cases.values.at("scales")) {
    cases.add("far start", "scaled/" + number_text(scale), "a chain of 20 scaled by this",
              [scale] {
                Mesh mesh = chain(20);
                mesh.start.x *= scale;
                Trial trial = trial_of(std::move(mesh), 1.0 / 100, 20);
                // The release moves vertices by many edges a step.
                trial.energy_tolerance = closest_point_energy;
                return trial;
              },
              {survive(strain_limiting, "each edge is corrected along itself, from any position"),
               refuse(start_direction, "links turn over in a step").or_else(survives, thrown),
               survive(springs, "the energy has a minimum").or_else(refuses, thrown),
               survive(everyone, close).or_else(refuses, thrown)});
  }
  cases.add("far start", "noise", "11 x 11 cloth, every vertex displaced by up to 30 % of an edge",
            [] {
              Mesh mesh = hung_cloth(11);
              std::mt19937_64 random(7);
              add_noise(mesh.start.x, mesh.parts.pinned, 0.03, random);
              return trial_of(std::move(mesh), 1.0 / 100, 20);
            },
            {refuse(start_direction,
                    "corrections of a third of an edge along directions of the start: nothing "
                    "says that a solution exists")
                 .or_else(survives, "nor that none does"),
             survive(everyone, close)});
  // At the pin all weight pulls at one vertex's mass: transverse waves of the string there have
  // omega = 2 (T / (m l))^1/2. A constraint direction from the start of the step is explicit for
  // them.
  const std::vector<Expectation> stiff_waves{
      refuse(start_direction,
             "transverse waves beside the pin with omega h > 2 grow until links turn by 60 "
             "degrees in a step"),
      survive(everyone, "each step begins afresh: no drift")};
  cases.add("noise every step", "drift/chain",
            "every step of a hanging chain starts with errors of up to 10 % of an edge (C10)",
            [] { return with_noise_every_step(ten_seconds(chain(20, down))); },
            {refuse(start_direction,
                    "each step's noise leaves velocities of 0.3 m/s, which nothing damps: after a "
                    "second links turn by 60 degrees in a step"),
             stiff_waves.back()});
  cases.add(
      "noise every step", "drift/cloth", "the same for an 11 x 11 cloth, 5 % of an edge",
      [] { return with_noise_every_step(ten_seconds(hung_cloth(11))); }, stiff_waves);
  cases.add(
      "ten seconds", "swing/chain", "a chain of 20 swings for 10 s, h = 1/100 s (C10)",
      [] { return ten_seconds(chain(20)); }, stiff_waves);
  cases.add(
      "ten seconds", "swing/cloth",
      "an 11 x 11 cloth held at one corner swings for 10 s, h = 1/100 s",
      [] { return ten_seconds(hung_cloth(11)); }, stiff_waves);
}

// ---- Not a number: refused at the door ----

void add_impossible_numbers(Cases& cases) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinity = std::numeric_limits<double>::infinity();
  const auto add = [&](const std::string& what, double value, void (*put)(Mesh&, double)) {
    const std::string name = what + " " + number_text(value);
    cases.add("not a number", "door/" + name, name + " of a vertex or edge",
              [=] {
                Mesh mesh = chain(4);
                put(mesh, value);
                return trial_of(std::move(mesh), 0.01, 3);
              },
              {refuse(everyone, "at the door, naming it")});
  };
  for (const double value : {nan, infinity}) {
    add("position", value, [](Mesh& m, double v) { m.start.x(1, 2) = v; });
    add("velocity", value, [](Mesh& m, double v) { m.start.v(0, 3) = v; });
  }
  for (const double value : {nan, infinity, 0.0, -1.0}) {
    add("mass", value, [](Mesh& m, double v) { m.parts.mass[2] = v; });
    add("length", value, [](Mesh& m, double v) { m.parts.rest_length[1] = v; });
  }
}

}  // namespace harness::cases
