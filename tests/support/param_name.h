// Contestants as GoogleTest's parameters, whose names take letters, digits and _ only.
#pragma once

#include "solvers/registry.h"

namespace inextensible::names {

// gauss_seidel@bdf2 is gauss_seidel_in_bdf2.
inline constexpr auto contestant_name = [](const auto& info) {
  std::string name = info.param;
  if (const std::size_t at = name.find('@'); at != name.npos) name.replace(at, 1, "_in_");
  return name;
};

// Those of these settings that the solver has.
inline Settings those_of(const char* solver, const Settings& wanted) {
  Settings its;
  for (const SettingInfo& info : find_backend(solver)->settings)
    if (const auto at = wanted.find(info.name); at != wanted.end()) its.insert(*at);
  return its;
}

template <class Fits>
std::vector<const char*> rows_that(const Fits& fit) {
  std::vector<const char*> names;
  for (const Backend& row : backends())
    if (fit(row)) names.push_back(row.name);
  return names;
}

}  // namespace inextensible::names
