#include "harness/base/paths.h"

#include <filesystem>

#include "build_info.h"  // made by CMake

namespace harness {
namespace {

// The share folder beside an installed program, "" for one in a build folder.
const std::string& share_folder() {
  static const std::string folder = [] {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path share =
        (program.parent_path() / INEXTENSIBLE_DATA_FROM_PROGRAM).lexically_normal();
    return !error && fs::is_directory(share / "configs", error) ? share.string() : std::string();
  }();
  return folder;
}

}  // namespace

std::string source_path(const std::string& relative) {
  return (share_folder().empty() ? INEXTENSIBLE_SOURCE_DIR : share_folder()) + "/" + relative;
}

std::string local_result(const std::string& name) {
  const std::string folder = "results/local";
  const std::string place = share_folder().empty() ? source_path(folder) : folder;
  std::error_code error;  // the write that follows reports what is wrong
  std::filesystem::create_directories(place, error);
  return place + "/" + name;
}

}  // namespace harness
