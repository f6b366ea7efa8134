#include "harness/base/temporary_folder.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "harness/base/files.h"

namespace harness {

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  namespace fs = std::filesystem;
  const std::string stem = "bench-" + purpose + "-" + std::to_string(getuid()) + "-";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(fs::temp_directory_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(stem)) continue;
    const pid_t owner = std::atoi(name.c_str() + stem.size());
    if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH) fs::remove_all(entry, ignored);
  }
  std::string name =
      (fs::temp_directory_path() / (stem + std::to_string(getpid()) + "-XXXXXX")).string();
  if (!mkdtemp(name.data())) throw FileError(name, "make");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace harness
