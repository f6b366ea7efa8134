// The scenes in which the largest stable step is searched.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/stability/trial.h"

namespace harness {

struct StabilityScene {
  std::string name;
  std::function<Trial(double step)> build;  // one simulated second
  double largest, smallest;                 // s
};
std::vector<StabilityScene> stability_scenes();

}  // namespace harness
