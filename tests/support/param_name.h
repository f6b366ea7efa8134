// Names of GoogleTest's parameters, which take letters, digits and _ only.
#pragma once

#include <string>

namespace inextensible::names {

// The name of a contestant: gauss_seidel@bdf2 is gauss_seidel_in_bdf2.
inline std::string plain(std::string name) {
  if (const std::size_t at = name.find('@'); at != name.npos) name.replace(at, 1, "_in_");
  return name;
}

inline constexpr auto contestant_name = [](const auto& info) { return plain(info.param); };

}  // namespace inextensible::names
