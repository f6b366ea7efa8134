// Fabrics whose weight, bending and drape were measured on the same cloths.
#pragma once

#include <numbers>
#include <span>
#include <string_view>

namespace harness {

// Matsudaira, Masuda, Wada and Yokura 2015, "Shape Factor of Flared Skirts Compared with That of
// Circular Fabrics", Journal of Textile Engineering 61(6), tables 1 and 2: Kawabata's instruments,
// means of warp and weft.
struct Fabric {
  const char* name;
  double density;            // kg/m^2
  double bending;            // rigidity B, N m
  double drape_coefficient;  // of a disc of 15 cm on a table of 9 cm, Cusick 1965, %
};

std::span<const Fabric> fabrics();
const Fabric& fabric(std::string_view name);  // throws std::out_of_range

// Shear stiffness in N/m that is assumed for all: 1 gf/(cm degree), the usual order of magnitude of
// apparel fabrics on Kawabata's shear tester.
inline constexpr double fabric_shear = 9.80665e-3 / 1e-2 * 180 / std::numbers::pi;

}  // namespace harness
