// Numbers as tables and pages say them.
#pragma once

#include <string>

#include "harness/base/statistics.h"

namespace harness::analysis {

// As people call it: of a mesh its file's name, "shirt.obj" of "mesh:clothes/shirt.obj,pins=y>1.2".
std::string scene_words(const std::string& scene);
std::string percent(double fraction);    // "1.2 %"
std::string time_words(double seconds);  // "1.23 s", "41.3 ms", "0.51 ms"
// "3.5 (3.3-3.8)" with its 95 % interval; "3.5 (?)": it is not known.
std::string text(const Ratio& ratio);

}  // namespace harness::analysis
