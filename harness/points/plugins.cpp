#include "harness/points/plugins.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "solvers/plugin.h"

namespace harness {
namespace {

std::vector<Plugin> loaded;

using EntryPoint = decltype(&inextensible_plugin);

EntryPoint entry_point(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw std::runtime_error("there is no such file");
  // A path without a slash would be looked for in the system's folders. What is missing is missed
  // now, not in the middle of a sweep.
  void* library = dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw std::runtime_error(dlerror());
  void* symbol = dlsym(library, "inextensible_plugin");
  if (!symbol)
    throw std::runtime_error(
        "it is not a plug-in: it has no function inextensible_plugin (solvers/plugin.h)");
  return reinterpret_cast<EntryPoint>(symbol);
}

void check_stamp(const InextensiblePlugin& plugin) {
  const auto refuse = [](const std::string& why, std::int64_t there, std::int64_t here) {
    throw std::runtime_error("it was built differently: " + why + " is " + std::to_string(there) +
                             " there, " + std::to_string(here) +
                             " here; build it against this program's headers");
  };
  if (plugin.abi != INEXTENSIBLE_PLUGIN_ABI)
    refuse("version of the plug-in interface", plugin.abi, INEXTENSIBLE_PLUGIN_ABI);
  if (plugin.stamp_items != std::size(inextensible_stamp))
    refuse("length of its stamp", plugin.stamp_items, std::size(inextensible_stamp));
  for (std::size_t i = 0; i < std::size(inextensible_stamp); ++i) {
    const InextensibleStampItem &here = inextensible_stamp[i], &there = plugin.stamp[i];
    if (here.value != there.value) refuse(here.what, there.value, here.value);
  }
}

Plugin add(const std::string& path) {
  const InextensiblePlugin* table = entry_point(path)();
  if (!table) throw std::runtime_error("inextensible_plugin() returned nothing");
  check_stamp(*table);
  Plugin plugin{std::filesystem::path(path).filename().string(),
                table->version ? table->version : "",
                {},
                table->optimized};
  if (!has_form(plugin.version, "[ -~]+"))
    throw std::runtime_error("its version is not printable text");
  const std::span rows(table->backends, table->backend_count);
  if (rows.empty()) throw std::runtime_error("it brings no solver");
  inextensible::add_backends(rows);
  for (const auto& row : rows) plugin.solvers.emplace_back(row.name);
  return plugin;
}

}  // namespace

void load_plugin(const std::string& path) {
  try {
    loaded.push_back(add(path));
  } catch (const std::exception& error) {
    std::string why = error.what();
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw UsageError("plug-in '" + path + "': " + why);
  }
}

const std::vector<Plugin>& loaded_plugins() { return loaded; }

}  // namespace harness
