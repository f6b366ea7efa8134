// Masses of unlike vertices, long chains and large cloths, and cloth on a ball.
#include <algorithm>
#include <cmath>

#include "harness/base/text.h"
#include "harness/stability/cases.h"

namespace harness::cases {

// ---- Masses of unlike vertices ----

namespace {

// Light beads on a string that a mass `ratio` times theirs pulls taut: their transverse waves have
// omega = 2 (T / (m l))^1/2. A constraint direction that is known before the step's end is explicit
// for them, and stable up to omega h = 2.
Expectation waves_of_the_heavy_end(double ratio) {
  // T = 1.4 m/s^2 times the heavy mass after 0.1 s, l = 0.05 m, h = 1/400 s
  const double omega_h = 2 * std::sqrt(1.4 * ratio / 0.05) / 400;
  if (omega_h < 1) return survive(start_direction, "transverse waves with omega h < 1");
  return refuse(start_direction,
                "transverse waves with omega h > 2 grow until links turn by 60 degrees in a step, "
                "where no solution exists")
      .or_else(survives, "the string's own length bounds how far they grow");
}

// In a pass a multiplier moves a heavy vertex by multiplier_penalty / ratio of its edge's
// elongation, at both of its edges: dual methods mind the ratio of masses (Macklin et al. 2020).
Expectation multipliers_between(double ratio) {
  const double passes = 5 * ratio / (2 * multiplier_penalty);  // to 1 % of a load: 5 e-foldings
  if (passes < 1e5) return survive(multipliers, "passes grow with the ratio, up to some thousand");
  if (passes > 1e6)
    return refuse(multipliers, "passes grow with the ratio, far beyond the 1e5 allowed");
  return refuse(multipliers, "2.5e5 passes from no load, where 1e5 are allowed")
      .or_else(survives, "the last step's multipliers leave a part of these");
}

std::vector<Expectation> light_between(double ratio) {
  std::vector<Expectation> expected{multipliers_between(ratio),
                                    survive(end_direction, "implicit in the tension"),
                                    survive(springs, "implicit in the tension")};
  const auto then = [&](std::initializer_list<Expectation> more) {
    expected.insert(expected.end(), more);
    return expected;
  };
  // T = 0.5 N, l = 0.05 m, a light mass of 0.048 kg / ratio, h = 1/400 s
  const double square = 4 * 0.5 * ratio / (0.048 * 0.05) / (400.0 * 400);  // (omega h)^2
  if (square < 2)
    return then({survive(strain_limiting, "some hundred passes times 1 + ln(ratio)"),
                 survive(everyone, "transverse waves with omega h < 2")});
  if (square > 1000)
    return then(
        {refuse(strain_limiting, "passes grow with the ratio, beyond the 1e5 allowed"),
         refuse({"yarn_projection@bdf2", "fast_projection_adaptive@bdf2"}, "as for everyone below")
             .or_else(survives,
                      "yarns are brought to 0.8 of the limit: whether a wave leaves the room that "
                      "is left to it is up to rounding"),
         refuse(everyone,
                "transverse waves overshoot more than thousandfold in a step: no direction that "
                "is not implicit follows them")});
  return then({survive(strain_limiting, "as many passes as the ratio, a tenth of those allowed")
                   .or_else(refuses, "ten times the ratio is as good an estimate"),
               refuse(everyone, "transverse waves with omega h > 2 grow")
                   .or_else(survives,
                            "within the limit a bead has room for a tenth of an edge, and waves "
                            "stay within it")});
}

}  // namespace

void add_mass_ratios(Cases& cases) {
  for (const double ratio : cases.values.at("ratios")) {
    const std::string value = number_text(ratio);
    cases.add("heavy end", "heavy_end/" + value, "last vertex heavier by this",
              [ratio] {
                Mesh mesh = chain(20);
                mesh.parts.mass.back() *= ratio;
                return trial_of(std::move(mesh), 1.0 / 400, 40);
              },
              {waves_of_the_heavy_end(ratio),
               survive(strain_limiting,
                       "only the last edge is slow, and nothing pulls at it: the end falls freely"),
               survive(everyone, "a direct solve does not mind")});
    cases.add(
        "light between heavy", "light_between/" + value, "every other vertex lighter by this",
        [ratio] {
          Mesh mesh = chain(20);
          for (std::size_t i = 1; i < 20; i += 2) mesh.parts.mass[i] /= ratio;
          Trial trial = trial_of(std::move(mesh), 1.0 / 400, 40);
          // two links between heavy ends
          trial.slack = std::sqrt(3 * trial.strain_limit / 8) * 0.1;
          return trial;
        },
        light_between(ratio));
    cases.add("heavy patch", "heavy_patch/" + value,
              "11 x 11 cloth pinned closer, its middle 3 x 3 heavier by this",
              [ratio] {
                Mesh mesh = hung_cloth(11);
                for (int i = 4; i < 7; ++i)
                  for (int j = 4; j < 7; ++j) mesh.parts.mass[11 * i + j] *= ratio;
                return trial_of(std::move(mesh), 1.0 / 400, 40);
              },
              {survive(everyone,
                       "in 0.1 s it falls by half an edge, and only what is next to the pin is "
                       "pulled: the weight falls freely")});
  }
}

// ---- Long chains and large cloths ----

namespace {

// After ten steps of 1/400 s a chain has fallen by 3.4 mm, that is by `links` / 300 links. So many
// hang from the pin, and seven times as many are turned beyond the limit of 1 %.
std::vector<Expectation> long_chain(int links) {
  std::vector<Expectation> expected;
  if (links >= 3000)
    expected.push_back({{"pbd_substeps"},
                        Outcome::diverged,
                        "a sweep carries a load by some edges: the first link follows the pin's "
                        "pull alone, and is torn to several times its length"});
  if (links > 30000) {
    expected.push_back({{"soft_step"}, Outcome::diverged, expected.front().why});
    expected.push_back(refuse(multipliers,
                              "along the 340 links that hang a load goes by an edge a pass, "
                              "squared: 1e5 passes, where their budget is 2000"));
  } else if (links >= 3000) {
    expected.push_back(survive(multipliers,
                               "along the 34 links that hang a load goes by an edge a pass, "
                               "squared: some thousand passes of the 20000 in their budget"));
  }
  expected.push_back(survive(end_direction, "implicit in the tension: all turn at once"));
  expected.push_back(survive(springs, "a direct solve does not mind the number of links"));
  expected.push_back(links < 300
                         ? survive(start_direction, "no link turns by 60 degrees in a step")
                         : refuse(start_direction,
                                  "links beside the pin turn by more than 60 degrees in a step: "
                                  "no multiple of their old directions reaches their length"));
  if (links < 3000) {
    expected.push_back(
        survive(strain_limiting, "an edge a pass, squared: some thousand passes at most"));
    expected.push_back(survive(everyone, "an edge an iteration: 30 of the 200 allowed at most"));
  } else if (links > 30000) {
    expected.push_back(
        refuse(strain_limiting,
               "an edge a pass, squared: a million passes, where their budget is some thousand"));
    expected.push_back(
        refuse(everyone,
               "a kink moves by an edge an iteration: over the steps 300 to 2000 of 200 allowed"));
  } else {
    expected.push_back(
        refuse(strain_limiting,
               "an edge a pass, squared: 60000 passes, where their budget is 20000")
            .or_else(survives,
                     "the estimate is one of order, and relaxation gains a factor of some"));
    expected.push_back(
        refuse(everyone, "a kink moves by an edge an iteration: 240 links, 200 iterations allowed")
            .or_else(survives, "34 of them hang straight, where a few iterations do"));
  }
  return expected;
}

// Ten steps, with a budget of edge visits that passes may spend on a step, and of iterations of
// projections.
Trial with_budget(Mesh mesh) {
  Trial trial = trial_of(std::move(mesh), 1.0 / 400, 10);
  const double passes = std::max(100.0, 2e8 / trial.scene.problem->constraints());
  for (const auto& backend : inextensible::backends()) {
    if (!inextensible::is_built_in(backend.name) ||
        backend.strain_control != inextensible::StrainControl::strain_limit)
      continue;
    if (backend.direction == strain_limiting || multipliers.contains(backend.name))
      trial.settings[backend.name] = {{"max_iterations", std::min(1e5, std::floor(passes))}};
    if (backend.direction == current_direction)
      trial.settings[backend.name] = {{"max_iterations", 200.0}};
  }
  return trial;
}

}  // namespace

void add_large(Cases& cases) {
  for (const double value : cases.values.at("links")) {
    const int n = static_cast<int>(value);
    cases.add(
        "long chain", "chain/" + std::to_string(n), "this many links, falling, h = 1/400 s",
        [n] { return with_budget(chain(n)); }, long_chain(n));
  }
  for (const double value : cases.values.at("sides")) {
    const int n = static_cast<int>(value);
    cases.add("large cloth", "cloth/" + std::to_string(n),
              "this many vertices a side, held at one corner, h = 1/400 s",
              [n] { return with_budget(hung_cloth(n)); },
              {survive(everyone,
                       "in ten steps it falls by less than an edge, and only what is next to the "
                       "pin is pulled")});
  }
}

// ---- Cloth on a ball, with contact inside the solve ----
// What lies on it must keep its lengths and stay outside in the same step.

namespace {

// 11 x 11 vertices, so that edges are two fifths of the ball's radius.
Scene on_a_ball(SceneParameters given = {}) {
  given["n"] = 11;
  return scene_of("drape", given);
}

// Until the cloth lies on the ball, and its sides hang.
Trial fall(Scene scene) { return trial_of(std::move(scene), 1.0 / 200, 40); }

bool takes_none(const inextensible::Backend& backend) {
  return !backend.takes_collider && inextensible::is_built_in(backend.name);
}

}  // namespace

void add_contact(Cases& cases) {
  const std::vector<Expectation> can_be_met{
      refuse(Solvers(takes_none), "takes no obstacle, at the door"),
      survive(everyone,
              "the cloth as it was is permissible and outside, but for a move along the surface: "
              "both can be met in every step, and no edge turns by 60 degrees in one")};
  const struct {
    const char *name, *what, *parameter;
    double value;
  } balls[] = {
      {"smooth", "11 x 11 cloth falls onto a ball without friction", "friction", 0},
      {"sticky", "the same with friction 10: what has touched the ball stays there", "friction",
       10},
      {"corners", "the same on an icosahedron of 20 faces", "subdivisions", 0},
  };
  for (const auto& ball : balls)
    cases.add(
        "contact", std::string("contact/") + ball.name, ball.what,
        [ball] {
          return fall(on_a_ball({{ball.parameter, ball.value}}));
        },
        can_be_met);
  cases.add("contact", "contact/fast", "the same at 5 m/s, a quarter of an edge in a step",
            [] {
              Scene scene = on_a_ball();
              scene.start.v.row(1).setConstant(-5);
              return fall(std::move(scene));
            },
            {can_be_met.front(),
             survive(start_direction, "no edge turns by 60 degrees in a step")
                 .or_else(refuses,
                          "edges turn by up to 30, so that along their old directions an "
                          "iteration gains little, and friction takes part of that: 50 may not "
                          "do"),
             can_be_met.back()});
  cases.add(
      "contact", "contact/inside", "the same from a start 2 cm inside the ball",
      [] {
        Scene scene = on_a_ball();
        scene.start.x.row(1).array() -= 0.021;
        Trial trial = fall(std::move(scene));
        trial.energy_tolerance = -1;  // it is thrown out
        return trial;
      },
      can_be_met);
}

}  // namespace harness::cases
