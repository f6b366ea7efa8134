#include "harness/points/context.h"

#include <cholmod.h>
#include <gnu/libc-version.h>
#include <gsl/gsl_version.h>
#include <omp.h>
#include <sys/utsname.h>
#include <umfpack.h>

#include <Eigen/Core>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "build_info.h"  // made by CMake
#include "harness/base/child_process.h"
#include "harness/base/files.h"
#include "harness/base/text.h"
#include "harness/points/plugins.h"

extern "C" {  // OpenBLAS; its own header clashes with GSL's
void openblas_set_num_threads(int threads);
int openblas_get_num_threads();
char* openblas_get_config();
char* openblas_get_corename();
}

namespace harness {
namespace {

std::string cpu_field(const std::string& name) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(':');
    if (line.starts_with(name) && colon != std::string::npos && colon + 2 <= line.size())
      return line.substr(colon + 2);
  }
  return "";
}

// What the program is built from and reads: other changes, of a text or a result, do not count.
constexpr const char* program_parts =
    "CMakeLists.txt CMakePresets.json cmake configs harness solvers";

// Output of git in the source folder, "" without git or outside a checkout.
std::string git(const std::string& arguments) {
  const std::string command = "git -C '" INEXTENSIBLE_SOURCE_DIR "' " + arguments;
  const std::string text = run_program({"sh", "-c", command}, 60).out;
  return text.substr(0, text.find_last_not_of('\n') + 1);
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm local{};
  localtime_r(&time, &local);
  std::array<char, 64> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%FT%T%z", &local);
  return std::string(text.data(), length).insert(length - 2, ":");
}

json libraries_json() {
  const auto dotted = [](auto... parts) {
    std::string text;
    ((text += (text.empty() ? "" : ".") + std::to_string(parts)), ...);
    return text;
  };
  return {{"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"cholmod", dotted(CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION)},
          {"umfpack", dotted(UMFPACK_MAIN_VERSION, UMFPACK_SUB_VERSION, UMFPACK_SUBSUB_VERSION)},
          {"gsl", GSL_VERSION},
          {"blas",
           {{"name", std::string(openblas_get_config())},
            {"core", std::string(openblas_get_corename())},
            {"threads", openblas_get_num_threads()}}}};
}

}  // namespace

const char* version() { return INEXTENSIBLE_VERSION; }

void use_one_thread(char** argv) {
  const char* threads = std::getenv("OPENBLAS_NUM_THREADS");
  if (!threads || std::string(threads) != "1") {
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    execv("/proc/self/exe", argv);  // goes on where that fails
  }
  openblas_set_num_threads(1);
  omp_set_max_active_levels(0);  // CHOLMOD's num_threads clause outvotes OMP_NUM_THREADS
}

std::string counters_fingerprint() {
  json libraries = libraries_json();
  // Not its kernel, which OPENBLAS_CORETYPE chooses: "OpenBLAS 0.3.21" of "OpenBLAS 0.3.21 ...
  // Zen".
  const std::string blas = libraries["blas"]["name"];
  libraries["blas"] = blas.substr(0, blas.find(' ', blas.find(' ') + 1));
  libraries["libc"] = gnu_get_libc_version();  // its mathematics is part of every trajectory
  utsname system{};
  if (uname(&system) == 0) libraries["instruction set"] = system.machine;
  const std::string flags = INEXTENSIBLE_FLAGS;
  const bool native = flags.find("=native") != std::string::npos;
  return fnv1a(INEXTENSIBLE_COMPILER + flags + (native ? cpu_field("model name") : "") +
               libraries.dump());
}

json machine_context() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  std::array<double, 3> load{};
  const bool load_known = getloadavg(load.data(), 3) == 3;
  std::string governor;
  std::getline(std::ifstream("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"), governor);
  const std::string commit = git("rev-parse HEAD");
  const json build = {
      {"git", commit},
      {"dirty",
       !git(std::string("status --porcelain --untracked-files=no -- ") + program_parts).empty()},
      {"binary", fnv1a(read_file("/proc/self/exe", "program"))},
      {"compiler", INEXTENSIBLE_COMPILER},
      {"flags", INEXTENSIBLE_FLAGS},
      {"type", INEXTENSIBLE_BUILD_TYPE}};
  const json libraries = libraries_json();
  const std::string cpu = cpu_field("model name");
  json context = {
      {"date", now()},
      {"host_name", host.data()},
      {"executable", "bench"},
      {"num_cpus", std::thread::hardware_concurrency()},
      {"mhz_per_cpu", static_cast<int>(std::atof(cpu_field("cpu MHz").c_str()))},
      {"cpu_model", cpu},
      {"cpu_scaling_enabled", !governor.empty() && governor != "performance"},
      {"cpu_scaling_governor", governor},
      {"load_avg", load_known ? json(load) : json::array()},
      {"library_build_type", std::string(INEXTENSIBLE_BUILD_TYPE) == "Debug" ? "debug" : "release"},
      {"build", build},
      {"libraries", libraries},
      {"counters_fingerprint", counters_fingerprint()},
      {"fingerprint",
       fnv1a(cpu + INEXTENSIBLE_COMPILER + INEXTENSIBLE_FLAGS + commit + libraries.dump())}};
  if (!loaded_plugins().empty()) context["plugins"] = loaded_plugins();
  return context;
}

std::string difference(const json& was, const json& is) {
  const json patch = json::diff(was, is);
  if (patch.empty()) return "";
  const json::json_pointer place(patch.at(0).at("path").get<std::string>());
  const auto text = [&place](const json& document) {
    return document.contains(place) ? value_text(document.at(place)) : std::string("not there");
  };
  return place.to_string().substr(1) + " is " + text(is) + ", was " + text(was);
}

}  // namespace harness
