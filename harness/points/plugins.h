// Methods from shared libraries and Python files (`bench --plugin FILE`, solvers/inextensible.h).
#pragma once

#include <nlohmann/json.hpp>

#include "solvers/methods/backend.h"

namespace harness {

struct Plugin {
  std::string file;     // name without its folder
  std::string version;  // the plug-in's own
  std::string hash;     // of the file
  std::vector<std::string> solvers;
  bool optimized = false;  // by the compiler; if not, its times say nothing
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Plugin, file, version, hash, solvers, optimized)

// Adds the file's methods to the registry; at program start. A child loads it first, so that one
// that crashes or ends the program is refused. Locale and floating-point environment stay as they
// are. Throws UsageError, having added nothing, if it is not a plug-in, has another version of the
// interface, or brings a solver that exists.
void load_plugin(const std::string& path);

const std::vector<Plugin>& loaded_plugins();  // in the order of loading

// ---- Programs of their own: `bench --plugin 'cmd:./my_engine --bench'`. The scene goes to them as
// files (scenes/scene_folder.h), steps as numbers through pipes (docs/plugins.md) ----

struct ProcessSolver {
  inextensible::Backend row;
  std::string version;
};

// Starts the program, which describes itself, and ends it. Throws std::runtime_error, saying what
// is wrong. command: as for a shell; its texts live until this program ends.
ProcessSolver process_solver(const std::string& command);

}  // namespace harness
