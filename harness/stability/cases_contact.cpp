// Cloth on a ball, with contact inside the solve: what lies on it must keep its lengths and stay
// outside in the same step.
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;

namespace {

constexpr double h = 1.0 / 200;
constexpr int steps = 40;  // the cloth lies on the ball, and its sides hang

// 11 x 11 vertices, so that edges are two fifths of the ball's radius.
Scene on_a_ball(const SceneParameters& given) {
  SceneParameters all{{"n", 11}};
  all.insert(given.begin(), given.end());
  return scene_of("drape", all);
}

const std::vector<Expectation> can_be_met{
    {everyone, survives,
     "the cloth as it was is permissible and outside, but for a move along the surface: both can "
     "be met in every step, and no edge turns by 60 degrees in one"}};

// Before what is expected of the others.
std::vector<Expectation> with_those_that_take_none(std::vector<Expectation> expectations) {
  for (const auto& backend : inextensible::backends()) {
    if (backend.takes_collider || !inextensible::is_built_in(backend.name)) continue;
    expectations.insert(expectations.begin(),
                        {Solvers{{backend.name}}, refuses, "takes no obstacle, at the door"});
  }
  return expectations;
}

}  // namespace

void add_contact(std::vector<HardCase>& cases, const HardCaseValues& /*values*/) {
  const auto add = [&cases](const char* name, const char* what, std::function<Trial()> build,
                            std::vector<Expectation> expectations) {
    cases.push_back({"contact", std::string("contact/") + name, what, std::move(build),
                     with_those_that_take_none(std::move(expectations))});
  };
  add(
      "smooth", "11 x 11 cloth falls onto a ball without friction",
      [] {
        return trial_of(on_a_ball({{"friction", 0}}), h, steps);
      },
      can_be_met);
  add(
      "sticky", "the same with friction 10: what has touched the ball stays there",
      [] {
        return trial_of(on_a_ball({{"friction", 10}}), h, steps);
      },
      can_be_met);
  add(
      "corners", "the same on an icosahedron of 20 faces",
      [] {
        return trial_of(on_a_ball({{"subdivisions", 0}}), h, steps);
      },
      can_be_met);
  add("fast", "the same at 5 m/s, a quarter of an edge in a step",
      [] {
        Scene scene = on_a_ball({});
        scene.start.v.row(1).setConstant(-5);
        return trial_of(std::move(scene), h, steps);
      },
      {{start_direction,
        survives,
        "no edge turns by 60 degrees in a step",
        {{refuses,
          "edges turn by up to 30, so that along their old directions an iteration gains little, "
          "and friction takes part of that: 50 may not do"}}},
       can_be_met.front()});
  add(
      "inside", "the same from a start 2 cm inside the ball",
      [] {
        Scene scene = on_a_ball({});
        scene.start.x.row(1).array() -= 0.021;
        Trial trial = trial_of(std::move(scene), h, steps);
        trial.energy_tolerance = -1;  // it is thrown out
        return trial;
      },
      can_be_met);
}

}  // namespace harness
