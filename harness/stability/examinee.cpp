#include "harness/stability/examinee.h"

#include <algorithm>
#include <bit>
#include <random>

namespace harness {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;

Case scene_case(const std::string& name, const char* type, const SceneParameters& given,
                double step, int steps) {
  const auto found_scene = find_scene(type);
  const SceneType& scene = *found_scene;
  return {name, scene.build(complete_parameters(scene, given)), step, steps, 0.01};
}

Case net(std::uint64_t seed, int n, int pins, double speed, double step, int steps, double limit) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  inextensible::ProblemParts parts;
  parts.gravity.setZero();
  Scene scene;
  scene.size = n;
  scene.start.x.resize(3, n * n);
  scene.start.v.setZero(3, n * n);
  const auto join = [&](int a, int b) {
    if (a < pins && b < pins) return;
    parts.edges.push_back({a, b});
    parts.rest_length.push_back((scene.start.x.col(b) - scene.start.x.col(a)).norm());
  };
  for (int v = 0; v < n * n; ++v) {
    const int row = v / n, column = v % n;
    scene.start.x.col(v) << column + uniform(-0.2, 0.2), uniform(-0.3, 0.3),
        row + uniform(-0.2, 0.2);
    parts.mass.push_back(uniform(0.1, 1));
    if (v < pins) {
      parts.pinned.push_back(v);
    } else {
      for (int axis = 0; axis < 3; ++axis) scene.start.v(axis, v) = uniform(-speed, speed);
    }
    if (column > 0) join(v - 1, v);
    if (row > 0) join(v, v - n);  // both orientations occur
  }
  scene.problem = std::make_shared<const Problem>(std::move(parts));
  return {
      "net of " + std::to_string(n) + " x " + std::to_string(n) + ", seed " + std::to_string(seed),
      std::move(scene), step, steps, limit};
}

std::unique_ptr<inextensible::Stepper> Examinee::stepper(
    const Case& c, const inextensible::Settings& settings) const {
  try {
    return inextensible::make_stepper(backend.name, c.scene.problem,
                                      {c.limit, options.seed, settings});
  } catch (const std::invalid_argument& error) {
    throw NotTaken(error.what());
  }
}

SceneParameters Examinee::drape(int n) const {
  SceneParameters given{{"n", n}};
  if (!backend.takes_shear) given["shear"] = 0;
  if (!backend.takes_collider) given["radius"] = 0;
  return given;
}

Finding judged(bool passed, const std::string& check, const std::string& measured,
               const std::string& advice) {
  if (passed) return {Finding::Grade::pass, check, measured, ""};
  return {Finding::Grade::fail, check, measured, advice};
}

Finding not_applicable(const std::string& check, const std::string& why) {
  return {Finding::Grade::not_applicable, check, why, ""};
}

bool same_bits(const Positions& a, const Positions& b) {
  return a.cols() == b.cols() &&
         std::equal(a.data(), a.data() + a.size(), b.data(), [](double p, double q) {
           return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
         });
}

bool same_bits(const State& a, const State& b) {
  return same_bits(a.x, b.x) && same_bits(a.v, b.v) && a.time == b.time;
}

}  // namespace harness
