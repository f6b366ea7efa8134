#include "files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "usage_error.h"

namespace harness {

std::string read_file(const std::string& path, const std::string& what) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw UsageError("cannot read the " + what + " '" + path + "'");
  return text.str();
}

void check_writable(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw UsageError("cannot make the folder '" + folder.string() + "': " + error.message());
  if (fs::is_directory(target)) throw UsageError("'" + path + "' is a folder; --out names a file");
  const std::string trial = path + ".partial";
  const int file = open(trial.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) throw UsageError("cannot write '" + path + "': " + std::strerror(errno));
  close(file);
  unlink(trial.c_str());
}

void write_atomically(const std::string& path, const std::string& text) {
  const std::string trial = path + ".partial";
  const auto fail = [&] {
    throw std::runtime_error("cannot write '" + trial + "': " + std::strerror(errno));
  };
  const int file = open(trial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail();
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0) {
      close(file);
      fail();
    }
    done += static_cast<std::size_t>(written);
  }
  if (fsync(file) != 0 || close(file) != 0 || rename(trial.c_str(), path.c_str()) != 0) fail();
}

}  // namespace harness
