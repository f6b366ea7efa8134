#include "harness/film/colours.h"

#include <algorithm>
#include <cmath>

namespace harness {

using Eigen::Vector3d;

namespace {

double decoded(double shade) {  // of sRGB
  return shade <= 0.04045 ? shade / 12.92 : std::pow((shade + 0.055) / 1.055, 2.4);
}

double encoded(double light) {
  light = std::clamp(light, 0.0, 1.0);
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace

Vector3d linear(const Vector3d& srgb) {
  return srgb.unaryExpr([](double c) { return decoded(c); });
}

std::array<std::uint8_t, 3> shade(const Vector3d& rgb) {
  std::array<std::uint8_t, 3> bytes{};
  for (int k = 0; k < 3; ++k)
    bytes[static_cast<std::size_t>(k)] =
        static_cast<std::uint8_t>(std::lround(255 * encoded(rgb[k])));
  return bytes;
}

Vector3d strain_colour(double over_limit) {
  struct Stop {
    double at;
    Vector3d rgb;
  };
  // Four times the limit is as red as it gets.
  static const std::array<Stop, 5> stops{{{0, {0.80, 0.78, 0.72}},
                                          {0.5, {0.58, 0.70, 0.80}},
                                          {1, {0.25, 0.50, 0.75}},
                                          {1.5, {0.95, 0.70, 0.25}},
                                          {4, {0.80, 0.12, 0.10}}}};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    if (!(over_limit < stops[i].at)) continue;
    const double part =
        std::max(0.0, over_limit - stops[i - 1].at) / (stops[i].at - stops[i - 1].at);
    return linear(Vector3d(stops[i - 1].rgb + part * (stops[i].rgb - stops[i - 1].rgb)));
  }
  return linear(stops.back().rgb);
}

}  // namespace harness
