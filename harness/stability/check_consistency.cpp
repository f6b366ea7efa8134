#include "harness/judge/drive.h"
#include "harness/judge/reference.h"
#include "harness/scenes/pendulum.h"
#include "harness/stability/checks.h"

namespace harness {

using inextensible::Positions;
using inextensible::State;
using inextensible::StrainControl;

Findings check_consistency(const Examinee& solver) {
  const char* check = "consistency";
  constexpr int links = 7;
  // Tolerance of the fine run, h = 0.00025 s, over the scene's size: five times g t h / 2, by which
  // symplectic Euler's free fall is off after 0.32 s.
  constexpr double largest_error = 2e-3;
  // Distances from a run of h/16: (1/2 - 1/16) / (1 - 1/16) = 0.47 for a method of first order, 1
  // for what does not vanish with h; between the two, on a logarithmic scale.
  constexpr double vanishing = 0.68;
  const Case c = scene_case("chain of 8", "chain", {{"n", links + 1}}, 0.32 / 80, 80);
  // How far a step is iterated is a tolerance, not a part of the formula: it must not be what
  // shows.
  inextensible::Settings settings;
  for (const auto& info : solver.backend.settings) {
    if (info.name == std::string("direction_tolerance")) settings[info.name] = 0.01;
  }
  std::vector<Positions> ends;
  for (const int refinement : {1, 2, 16}) {
    Case fine = c;
    fine.limit = 1e-6;
    const auto stepper = solver.stepper(fine, settings);
    State state = c.scene.start;
    const DriveState driven = drive(*stepper, state, {c.step / refinement, refinement * c.steps});
    if (driven.end == DriveState::End::refused)
      return {
          judged(false, check,
                 text("not measured: refuses h = 1/", 250 * refinement,
                      " s on a falling chain of 8 at strain limit 1e-6: ", driven.result.detail),
                 "an easy scene; look at the iteration limit and at what ends the iteration")};
    ends.push_back(state.x);
  }
  const double coarse = rms_distance(c.scene, ends[0], ends[2]),
               half = rms_distance(c.scene, ends[1], ends[2]);
  const std::string measured = text("halving h takes the distance to its own fine run from ",
                                    coarse, " to ", half, " (allowed ", vanishing * coarse, ")");
  const char* advice =
      "what a step changes must vanish with h: look for a damping, a relaxation or an offset a "
      "step that does not know h";
  const bool converges = half <= vanishing * coarse || coarse < 1e-9;
  if (solver.backend.strain_control == StrainControl::none)
    return {judged(converges, check, measured, advice)};
  Pendulum exact({std::vector<double>(links, 1.0 / (links + 1)),
                  std::vector<double>(links, 1.0 / links), 9.81},
                 std::vector<double>(links, 0.0));
  exact.advance(c.step * c.steps, 1e-12);
  const double error = rms_distance(c.scene, ends[2], exact.positions());
  return {judged(converges && error <= largest_error, check,
                 text(measured, ", and that is ", error, " from the exact motion (allowed ",
                      largest_error, ")"),
                 advice)};
}

}  // namespace harness
