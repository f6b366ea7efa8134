#include "harness/points/plugins.h"

#include <dlfcn.h>

#include <cfenv>
#include <clocale>
#include <deque>

#include "harness/base/child_process.h"
#include "harness/base/files.h"
#include "harness/base/text.h"
#include "solvers/c_method.h"
#include "solvers/registry.h"

namespace harness {
namespace {

std::vector<Plugin> loaded;
std::deque<InextensibleMethod>
    adopted_methods;  // of all plug-ins; rows of the registry refer to them
std::deque<std::vector<InextensibleSetting>> adopted_settings;

// A function of a library. What the library lacks is missed now, not in the middle of a sweep.
template <class Function>
Function function_of(const std::string& path, int scope, const char* name) {
  void* library = dlopen(path.c_str(), RTLD_NOW | scope);
  if (!library) throw std::runtime_error(dlerror());
  void* symbol = dlsym(library, name);
  if (!symbol)
    throw std::runtime_error(std::string("it is not a plug-in: it has no function ") + name +
                             " (solvers/inextensible.h)");
  return reinterpret_cast<Function>(symbol);
}

// A file of solvers in Python, which a library of its own knows how to load. That one's symbols,
// Python's, are for all: extension modules of Python want them.
const InextensiblePlugin* python_table(const std::string& path) {
  const std::string bridge = library_path("libinextensible_python.so");
  if (bridge.empty())
    throw std::runtime_error(
        "this bench was built without Python; build it again after apt-get install pybind11-dev "
        "python3-dev python3-numpy");
  using Load = const InextensiblePlugin* (*)(const char* path, const char** error);
  const char* error = "";
  const InextensiblePlugin* table =
      function_of<Load>(bridge, RTLD_GLOBAL, "inextensible_python")(path.c_str(), &error);
  if (!table) throw std::runtime_error(error);
  return table;
}

const InextensiblePlugin& table_of(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw std::runtime_error("there is no such file");
  // A path without a slash would be looked for in the system's folders.
  const std::string path = std::filesystem::absolute(file);
  const InextensiblePlugin* table =
      path.ends_with(".py")
          ? python_table(path)
          : function_of<decltype(&inextensible_plugin)>(path, RTLD_LOCAL, "inextensible_plugin")();
  if (!table) throw std::runtime_error("inextensible_plugin() returned nothing");
  if (table->abi != INEXTENSIBLE_ABI)
    throw std::runtime_error("it was built for version " + std::to_string(table->abi) +
                             " of the interface, this program has version " +
                             std::to_string(INEXTENSIBLE_ABI));
  if (!has_form(table->version ? table->version : "", "[ -~]+"))
    throw std::runtime_error("its version is not printable text");
  if (table->method_count < 1 || !table->methods) throw std::runtime_error("it brings no solver");
  return *table;
}

// A plug-in's array of structs, `size` bytes each there: fields that it does not know are 0.
template <class Struct>
std::vector<Struct> adopted(const Struct* first, std::int32_t count, std::uint32_t size) {
  std::vector<Struct> here(static_cast<std::size_t>(std::max(count, 0)));
  for (std::size_t i = 0; i < here.size(); ++i)
    std::memcpy(&here[i], reinterpret_cast<const char*>(first) + i * size,
                std::min<std::size_t>(size, sizeof(Struct)));
  return here;
}

// A crash here is not one of the program.
void try_in_child(const std::function<void()>& load) {
  const ChildOutcome child = run_in_child(
      [&load](Heartbeat&) {
        load();
        return std::string();
      },
      {.timeout = 60, .interrupted = interrupted});
  if (child.end == ChildOutcome::End::interrupted) throw Interrupted();
  if (child.end == ChildOutcome::End::threw) throw std::runtime_error(child.text);
  if (child.end == ChildOutcome::End::timed_out)
    throw std::runtime_error("it takes more than a minute to load");
  if (child.end != ChildOutcome::End::returned)
    throw std::runtime_error(ending(child) + " while it was loaded");
}

// The hash is that of the command, and of the program's file where it is one.
Plugin add_process(const std::string& command) {
  try_in_child([&command] { process_solver(command); });
  const ProcessSolver solver = process_solver(command);
  inextensible::add_backends({&solver.row, 1});
  const std::string program = command.substr(0, command.find(' '));
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(program, error);
  return {std::filesystem::path(program).filename().string(),
          solver.version,
          fnv1a(command + (is_file ? read_file(program, "plug-in") : "")),
          {solver.row.name},
          true};
}

Plugin add(const std::string& path) {
  constexpr std::string_view command_prefix = "cmd:";
  if (path.starts_with(command_prefix)) return add_process(path.substr(command_prefix.size()));
  try_in_child([&path] { table_of(path); });
  std::fenv_t numbers;
  std::fegetenv(&numbers);
  const std::string locale = std::setlocale(LC_ALL, nullptr);
  const InextensiblePlugin& table = table_of(path);
  std::fesetenv(&numbers);
  std::setlocale(LC_ALL, locale.c_str());
  Plugin plugin{std::filesystem::path(path).filename().string(),
                table.version,
                fnv1a(read_file(path, "plug-in")),
                {},
                table.optimized != 0};
  std::vector<inextensible::Backend> rows;
  for (InextensibleMethod& method : adopted(table.methods, table.method_count, table.method_size)) {
    method.settings =
        adopted_settings
            .emplace_back(adopted(method.settings, method.setting_count, table.setting_size))
            .data();
    rows.push_back(inextensible::row_of(adopted_methods.emplace_back(method)));
  }
  inextensible::add_backends(rows);
  for (const auto& row : rows) plugin.solvers.emplace_back(row.name);
  return plugin;
}

}  // namespace

void load_plugin(const std::string& path) {
  try {
    loaded.push_back(add(path));
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    std::string why = error.what();
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw UsageError("plug-in '" + path + "': " + why);
  }
}

const std::vector<Plugin>& loaded_plugins() { return loaded; }

}  // namespace harness
