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
inline constexpr double mg_cm2 = 1e-6 / (1e-2 * 1e-2);                // kg/m^2
inline constexpr double gf_cm2_cm = 9.80665e-3 * 1e-2 * 1e-2 / 1e-2;  // N m
inline constexpr std::array<Fabric, 4> fabrics{
    {{"cotton", 12.38 * mg_cm2, 0.118 * gf_cm2_cm, 82.9},     // broadcloth
     {"wool", 16.29 * mg_cm2, 0.067 * gf_cm2_cm, 49.8},       // tropical
     {"polyester", 11.65 * mg_cm2, 0.077 * gf_cm2_cm, 50.7},  // tropical
     {"polyester_faille", 10.43 * mg_cm2, 0.019 * gf_cm2_cm, 28.3}}};

inline const Fabric& fabric(std::string_view name) {  // throws std::out_of_range
  const auto* const found = std::ranges::find(fabrics, name, &Fabric::name);
  if (found == fabrics.end()) throw std::out_of_range("no fabric " + std::string(name));
  return *found;
}

// Shear stiffness in N/m that is assumed for all: 1 gf/(cm degree), the usual order of magnitude of
// apparel fabrics on Kawabata's shear tester.
inline constexpr double fabric_shear = 9.80665e-3 / 1e-2 * 180 / std::numbers::pi;

}  // namespace harness
