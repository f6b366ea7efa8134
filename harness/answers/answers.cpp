#include <algorithm>
#include <cmath>

#include "harness/answers/answer.h"
#include "harness/scenes/chain_scenes.h"
#include "harness/scenes/fabrics.h"
#include "harness/scenes/meshes.h"

namespace harness {
namespace {

// Four steps, or another number of them.
std::vector<double> from_step(double step, int count = 4) {
  std::vector<double> steps;
  for (; count > 0; --count, step /= 2) steps.push_back(step);
  return steps;
}

auto always(double value) {
  return [value](const AnswerScene& /*at*/) { return value; };
}

// What spins: its place, and the speed that it keeps.
//
// A method that brings free flight back along directions at the end of the step turns by the angle
// atan(sin a / (2 - cos a)) after one by the angle a, so that its rate falls as Omega(t) = Omega_0
// / sqrt(1 + 2 Omega_0^2 h t). One whose directions are of the start turns by equal angles. Both
// laws are tested to the last digits in tests/harness/scenes.
void add_spinning(std::vector<KnownAnswer>& all, const char* place, const char* rate,
                  const char* scene, const SceneParameters& given) {
  all.push_back(
      {place, scene, given, "distance from its place after one turn, RMS over its size",
       "a rigid rotation about the middle, held by tensions m Omega^2 times the distances "
       "of all that is farther out (Newton)",
       1e-6, from_step(0.01), always(0), distance_at_the_end});
  all.push_back(
      {rate, scene, given, "rate of turning after one second over the start's",
       "nothing slows it; by theory a method with directions of the end of the step keeps "
       "1 / sqrt(1 + 2 Omega_0^2 h t)",
       1e-6, from_step(0.01), always(1), turning_rate_kept});
}

// What hangs: the frequency and the damping of small oscillations, a catenary that stays and its
// tensions, and a chain that whirls.
double frequency_of(const AnswerScene& at) {
  return hanging_frequency(static_cast<int>(at.parameters.at("n")) - 1, row_link(at.parameters),
                           at.parameters.at("gravity"), static_cast<int>(at.parameters.at("mode")));
}

void add_hanging(std::vector<KnownAnswer>& all) {
  const SceneParameters long_enough{{"duration", 6}};
  const char* catenary =
      "link i of N has the slope m g (i - (N + 1) / 2) over the horizontal tension (Bernoulli, "
      "Huygens and Leibniz 1691 for the limit of many)";
  all.push_back({"swing_frequency", "hanging_chain", long_enough,
                 "frequency of the slowest small oscillation, rad/s",
                 "omega_k^2 = (g / l) x_k, x_k the zeros of the Laguerre polynomial of as many "
                 "links (for the limit of many Bernoulli 1733)",
                 1e-7, from_step(0.02), frequency_of, swing_frequency});
  all.push_back({"swing_kept", "hanging_chain", long_enough,
                 "part of its amplitude that an oscillation keeps in a period",
                 "nothing dissipates", 1e-7, from_step(0.02), always(1), swing_kept});
  const SceneParameters own;
  all.push_back({"catenary_place", "catenary", own,
                 "distance from its rest after one second, RMS over its length", catenary, 1e-7,
                 from_step(0.02), always(0), distance_at_the_end});
  all.push_back({"catenary_tensions", "catenary", own,
                 "largest deviation of a multiplier from its link's tension, over the largest "
                 "tension",
                 catenary, 1e-7, from_step(0.02), always(0), catenary_tensions, true});
  all.push_back({"whirl_place", "whirling_chain", own,
                 "distance from its place after one second, RMS over its length",
                 "a rigid rotation in which each link leads along the force on all below it "
                 "(Kolodner 1955)",
                 1e-6, from_step(0.02), always(0), distance_at_the_end});
}

// The falling folded chain and the whip: how fast the free end is.
double fall_time_of(const AnswerScene& at) {
  return folded_fall_time(folded_part, at.parameters.at("length"), at.parameters.at("gravity"));
}

void add_folded(std::vector<KnownAnswer>& all) {
  const SceneParameters fall{{"duration", 0.6}}, crack{{"duration", 1.2}};
  all.push_back({"fold_fall_time", "folded_chain", fall,
                 "time in which the free end falls 0.9 of the length, s",
                 "v^2 = g L s (2 - s) / (1 - s) (Calkin and March 1989), 0.85 of free fall over "
                 "the whole length; a chain of links follows to O(link / L)",
                 1e-4, from_step(0.0025), fall_time_of, folded_time, false, true, true});
  all.push_back({"whip_speed", "whip", crack,
                 "speed of the free end when it has gone 0.9 of the length, over the start's",
                 "v = v_0 / sqrt(1 - s): the energy stays, what moves becomes less; a chain of "
                 "links follows to O(link / L)",
                 1e-4, from_step(0.0025), always(1 / std::sqrt(1 - folded_part)), folded_speed,
                 false, true, true});
}

// A net that cannot stretch along warp and weft, with Hookean shear and bending and without what
// friction between yarns holds, is a model of real fabrics and no more. Methods that take forces
// first and keep edges to their lengths after that do not come to rest under shear as stiff as a
// fabric's: one undoes what the other does. Their figures then depend on the step; those of
// implicit springs do not.
KnownAnswer drape_of(const char* name, const Fabric& cloth) {
  SceneParameters disc{{"n", 61}, {"duration", 2}};
  disc["density"] = cloth.density;
  disc["bending"] = cloth.bending;
  return {name,
          "cusick",
          disc,
          "drape coefficient (Cusick), %, against that of the real fabric",
          "measured with weight and bending, shear assumed (Matsudaira, Masuda, Wada and Yokura "
          "2015)",
          1e-3,
          from_step(0.005, 2),
          always(cloth.drape_coefficient),
          drape_coefficient,
          false,
          true};
}

std::vector<KnownAnswer> all_answers() {
  std::vector<KnownAnswer> all;
  add_spinning(all, "net_place", "net_rate", "spinning_net", {{"n", 11}});
  add_spinning(all, "baton_place", "baton_rate", "baton", {});
  add_spinning(all, "hoop_place", "hoop_rate", "hoop", {});
  add_hanging(all);
  add_folded(all);
  const SceneParameters ball{{"n", 41}, {"subdivisions", 5}, {"duration", 0.3}};
  all.push_back({"fishnet", "drape", ball,
                 "deviation of the angle between warp and weft where the cloth lies on the ball, "
                 "RMS, degrees",
                 "w_uv = -sin(w) / R^2 (Chebyshev 1878, Mack and Taylor 1956)", 1e-3,
                 from_step(0.01), always(0), net_angle_deviation, false, true});
  all.push_back(drape_of("drape_of_cotton", fabric("cotton")));
  all.push_back(drape_of("drape_of_wool", fabric("wool")));
  all.push_back(drape_of("drape_of_faille", fabric("polyester_faille")));
  return all;
}

}  // namespace

AnswerScene answer_scene(std::string_view name, const SceneParameters& given) {
  const auto type = find_scene(name);
  const SceneParameters parameters = complete_parameters(*type, given);
  return {type, parameters, type->build(parameters)};
}

std::span<const KnownAnswer> known_answers() {
  static const std::vector<KnownAnswer> table = all_answers();
  return table;
}

const KnownAnswer* find_answer(std::string_view name) {
  const auto found = std::ranges::find(known_answers(), name, &KnownAnswer::name);
  return found == known_answers().end() ? nullptr : &*found;
}

}  // namespace harness
