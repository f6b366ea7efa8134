#include "harness/scenes/fabrics.h"

#include <array>
#include <stdexcept>
#include <string>

namespace harness {
namespace {

// Units of the tables.
constexpr double gram_force = 9.80665e-3, centimetre = 1e-2;                        // N, m
constexpr double bending_unit = gram_force * centimetre * centimetre / centimetre;  // gf cm^2/cm
constexpr double weight_unit = 1e-6 / (centimetre * centimetre);                    // mg/cm^2

constexpr std::array<Fabric, 4> measured{{
    {"cotton", 12.38 * weight_unit, 0.118 * bending_unit, 82.9},     // broadcloth
    {"wool", 16.29 * weight_unit, 0.067 * bending_unit, 49.8},       // tropical
    {"polyester", 11.65 * weight_unit, 0.077 * bending_unit, 50.7},  // tropical
    {"polyester_faille", 10.43 * weight_unit, 0.019 * bending_unit, 28.3},
}};

}  // namespace

std::span<const Fabric> fabrics() { return measured; }

const Fabric& fabric(std::string_view name) {
  for (const Fabric& row : measured) {
    if (row.name == name) return row;
  }
  throw std::out_of_range("no fabric " + std::string(name));
}

}  // namespace harness
