// The colours of films. Light is computed in linear colours from 0 to 1, files hold sRGB.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace harness {

Eigen::Vector3d linear(const Eigen::Vector3d& srgb);
std::array<std::uint8_t, 3> shade(const Eigen::Vector3d& rgb);  // in sRGB, of a linear colour

// Cloth's own colour up to the limit, warm beyond it. `over_limit`: strain over its limit.
Eigen::Vector3d strain_colour(double over_limit);  // linear

}  // namespace harness
