// Fabrics whose weight, bending and drape were measured on the same cloths.
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

namespace harness {

struct Fabric {
  const char* name;
  double density;            // kg/m^2
  double bending;            // rigidity B, N m
  double drape_coefficient;  // of a disc of 15 cm on a table of 9 cm, Cusick 1965, %
};

// Matsudaira, Masuda, Wada and Yokura 2015, "Shape Factor of Flared Skirts Compared with That of
// Circular Fabrics", Journal of Textile Engineering 61(6), tables 1 and 2: Kawabata's instruments,
// means of warp and weft; mg/cm^2 and gf cm^2/cm.
inline constexpr std::array<Fabric, 4> fabrics = [] {
  std::array<Fabric, 4> measured{{{"cotton", 12.38, 0.118, 82.9},     // broadcloth
                                  {"wool", 16.29, 0.067, 49.8},       // tropical
                                  {"polyester", 11.65, 0.077, 50.7},  // tropical
                                  {"polyester_faille", 10.43, 0.019, 28.3}}};
  constexpr double gram_force = 9.80665e-3, centimetre = 1e-2;  // N, m
  for (Fabric& fabric : measured) {
    fabric.density *= 1e-6 / (centimetre * centimetre);
    fabric.bending *= gram_force * centimetre * centimetre / centimetre;
  }
  return measured;
}();

inline const Fabric& fabric(std::string_view name) {  // throws std::out_of_range
  const auto* const found = std::ranges::find(fabrics, name, &Fabric::name);
  if (found == fabrics.end()) throw std::out_of_range("no fabric " + std::string(name));
  return *found;
}

// Shear stiffness in N/m that is assumed for all: 1 gf/(cm degree), the usual order of magnitude of
// apparel fabrics on Kawabata's shear tester.
inline constexpr double fabric_shear = 9.80665e-3 / 1e-2 * 180 / std::numbers::pi;

}  // namespace harness
