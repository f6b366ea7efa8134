#include "harness/stability/stability_scenes.h"

#include "harness/stability/case_parts.h"

namespace harness {

std::vector<StabilityScene> stability_scenes() {
  const auto scene = [](const char* name, const SceneParameters& given) {
    return
        [=](double step) { return case_parts::trial_of(case_parts::scene_of(name, given), step); };
  };
  return {{"chain of 20", scene("chain", {{"n", 20}}), 0.25, 1.0 / 6400},
          {"drape 11 x 11", scene("drape", {{"n", 11}}), 0.25, 1.0 / 3200},
          {"patch 11 x 11", scene("patch", {{"n", 11}}), 0.25, 1.0 / 3200},
          {"taut row of 30", scene("taut_row", {{"n", 31}}), 0.25, 1.0 / 6400}};
}

}  // namespace harness
