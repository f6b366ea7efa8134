// Methods from shared libraries and Python files (`bench --plugin FILE`, solvers/inextensible.h).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

}  // namespace harness
