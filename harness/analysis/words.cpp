#include "harness/analysis/words.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "harness/base/text.h"

namespace harness::analysis {

std::string scene_words(const std::string& scene) {
  if (!scene.starts_with("mesh:")) return scene;
  const std::string file = scene.substr(5, scene.find(',') - 5);
  return file.substr(file.find_last_of('/') + 1);
}

std::string percent(double fraction) { return number_text(100 * fraction, 3) + " %"; }

std::string time_words(double seconds) {
  return seconds >= 1 ? number_text(seconds, 3) + " s" : number_text(1e3 * seconds, 3) + " ms";
}

std::string text(const Ratio& ratio) {
  if (std::isnan(ratio.value)) return "?";
  if (!ratio.known() || !(ratio.value > 0))
    return number_text(ratio.value, ratio.value >= 100 ? 3 : 2) + " (?)";
  // As many decimals as show the interval's width and two digits of each number, but no more than
  // four digits of the value.
  const auto order = [](double x) { return static_cast<int>(std::floor(std::log10(x))); };
  const int most = std::max(0, 3 - order(ratio.value));
  const int width = ratio.high > ratio.low ? -order(ratio.high - ratio.low) : most;
  const int wanted = std::max(width, 1 - order(ratio.low));
  const auto fixed = [decimals = std::clamp(wanted, 0, most)](double x) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(decimals) << x;
    return out.str();
  };
  return fixed(ratio.value) + " (" + fixed(ratio.low) + "-" + fixed(ratio.high) + ")";
}

}  // namespace harness::analysis
