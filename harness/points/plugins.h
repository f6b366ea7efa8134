// Backends from shared libraries (`bench --plugin FILE`, solvers/plugin.h).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace harness {

struct Plugin {
  std::string file;     // name without its folder
  std::string version;  // the plug-in's own
  std::vector<std::string> solvers;
  bool optimized = false;  // by the compiler; if not, its times say nothing
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Plugin, file, version, solvers, optimized)

// Adds the file's backends to the registry; at program start. Throws UsageError, having added
// nothing, if it is not a plug-in, was built unlike this program, or brings a solver that exists.
void load_plugin(const std::string& path);

const std::vector<Plugin>& loaded_plugins();  // in the order of loading

}  // namespace harness
