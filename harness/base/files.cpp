#include "harness/base/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/base/errors.h"

namespace harness {

FileError::FileError(const std::string& path, const std::string& verb)
    : FileError(path, verb, std::strerror(errno)) {}

FileError::FileError(const std::string& path, const std::string& verb, const std::string& reason)
    : std::runtime_error("cannot " + verb + " '" + path + "': " + reason) {}

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
    const FileError error(path, "write");
    unlink(trial.c_str());
    throw error;
  };
  const int file = open(trial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail();
  bool whole = true;
  for (std::size_t done = 0; whole && done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    whole = written >= 0;
    if (whole) done += written;
  }
  whole = whole && fsync(file) == 0;
  const int reason = errno;
  close(file);
  errno = reason;
  if (!whole || rename(trial.c_str(), path.c_str()) != 0) fail();
}

}  // namespace harness
