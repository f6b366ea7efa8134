// Readings that several answers share, and the lists of answers, one file a family of scenes.
#pragma once

#include <vector>

#include "harness/answers/answer.h"

namespace harness {

// RMS distance from the scene's exact motion at the end of the run, over the scene's size.
std::unique_ptr<Reading> distance_at_the_end(const AnswerScene& at);

std::vector<KnownAnswer> spinning_answers();
std::vector<KnownAnswer> hanging_answers();
std::vector<KnownAnswer> folded_answers();
std::vector<KnownAnswer> fishnet_answers();
std::vector<KnownAnswer> fabric_answers();

}  // namespace harness
