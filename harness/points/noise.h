// The noise of a result: how far apart two contestants are that are the same program.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/points/point.h"

namespace harness {

// Over all places where both stand: |log(time of one / time of the other)|, of the times of
// their best points, in a step sweep of all points that ran to the end. A difference below q95 is
// none.
struct PairNoise {
  std::string one, other;  // contestants
  int places = 0;
  double median = 0, q95 = 0;
};

// None where `one` and double_of(one) have no place in common.
std::optional<PairNoise> pair_noise(const std::vector<PointResult>& points, const std::string& one);

// In words, where that is more than a result to be quoted may have, 6 %; else empty.
std::string noise_warning(const PairNoise& noise);

// `context.noise` of a result file; none in files without a pair.
nlohmann::json to_json(const PairNoise& noise);
std::optional<PairNoise> noise_of(const nlohmann::json& context);

}  // namespace harness
