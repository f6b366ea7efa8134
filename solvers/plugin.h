// A backend of your own, compiled outside this tree against the installed headers and loaded by
// `bench --plugin FILE`; from then on it is a solver like any other. Whole, with its CMake:
//
//   find_package(inextensible REQUIRED)
//   add_library(my_solver MODULE my_solver.cpp)
//   target_link_libraries(my_solver PRIVATE inextensible::plugin)
//
//   #include <solvers/plugin.h>
//   extern "C" const InextensiblePlugin* inextensible_plugin() {
//     static const std::vector<inextensible::Backend> rows{{"my_solver", ...}};
//     static const auto plugin = inextensible_plugin_of("1.0", rows);
//     return &plugin;
//   }
//
// The plug-in links headers only: the library is bench's own copy, so that methods which the
// plug-in builds on are those that it is measured against. A plug-in is never unloaded.
//
// Classes cross the border, so both sides must be built alike: compiler, standard library, Eigen
// and these headers, as a stamp says, and the same sanitizer. Optimization and -march may differ,
// since inextensible::plugin fixes Eigen's alignment.
#pragma once

#include <cstdint>
#include <iterator>
#include <span>

#include "solvers/registry.h"
#include "solvers/stepping/velocity_filter.h"
#include "solvers/systems/constraint_system.h"

// Counts up whenever these headers change what a plug-in relies on.
#define INEXTENSIBLE_PLUGIN_ABI 12

struct InextensibleStampItem {
  const char* what;
  std::int64_t value;
};

// What a plug-in hands over. It and all that it points to live until the program ends.
struct InextensiblePlugin {
  // The first three keep their place and meaning in every version.
  std::uint32_t abi;          // INEXTENSIBLE_PLUGIN_ABI of the headers it was built with
  std::uint32_t stamp_items;  // of `stamp`
  const InextensibleStampItem* stamp;

  const char* version;  // the plug-in's own, printable ASCII; goes to result files
  const inextensible::Backend* backends;  // rows as those of registry.cpp, names a-z 0-9 _
  std::uint64_t backend_count;            // at least 1
  bool optimized;  // compiled with optimization; its times count for something
};

// The one symbol that bench looks for; the plug-in defines it. Called once. An exception out of it
// is a refusal.
extern "C" __attribute__((visibility("default"))) const InextensiblePlugin* inextensible_plugin();

#if defined(__clang_major__)
#define INEXTENSIBLE_CLANG __clang_major__
#else
#define INEXTENSIBLE_CLANG 0
#endif

// Internal linkage here and below: the dynamic linker would give bench's to the plug-in otherwise,
// and every stamp would fit.
static constexpr InextensibleStampItem inextensible_stamp[] = {
    {"version of g++ (4: clang)", __GNUC__},
    {"version of clang (0: g++)", INEXTENSIBLE_CLANG},
    {"version of libstdc++", _GLIBCXX_RELEASE},
    {"_GLIBCXX_USE_CXX11_ABI", _GLIBCXX_USE_CXX11_ABI},
    {"version of Eigen",
     EIGEN_WORLD_VERSION * 10000 + EIGEN_MAJOR_VERSION * 100 + EIGEN_MINOR_VERSION},
    {"Eigen's alignment (EIGEN_MAX_ALIGN_BYTES)", EIGEN_DEFAULT_ALIGN_BYTES},
    {"size of Problem", sizeof(inextensible::Problem)},
    {"size of State", sizeof(inextensible::State)},
    {"size of WorkCounters", sizeof(inextensible::WorkCounters)},
    {"size of StepResult", sizeof(inextensible::StepResult)},
    {"size of Stepper", sizeof(inextensible::Stepper)},
    {"size of FilterStepper", sizeof(inextensible::FilterStepper)},
    {"size of Backend", sizeof(inextensible::Backend)},
    {"size of BackendOptions", sizeof(inextensible::BackendOptions)},
    {"size of EdgeConstraints", sizeof(inextensible::EdgeConstraints)},
    {"size of ConstraintSystem", sizeof(inextensible::ConstraintSystem)},
};

#if defined(__OPTIMIZE__)
#define INEXTENSIBLE_OPTIMIZED true
#else
#define INEXTENSIBLE_OPTIMIZED false
#endif

// The table with this translation unit's stamp.
static inline InextensiblePlugin inextensible_plugin_of(
    const char* version, std::span<const inextensible::Backend> rows) {
  return {INEXTENSIBLE_PLUGIN_ABI,
          std::size(inextensible_stamp),
          inextensible_stamp,
          version,
          rows.data(),
          rows.size(),
          INEXTENSIBLE_OPTIMIZED};
}
