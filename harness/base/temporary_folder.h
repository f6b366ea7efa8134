// A folder that goes away again, with the process or, if that was killed, before the next one of
// the same purpose.
#pragma once

#include <filesystem>
#include <string>

namespace harness {

class TemporaryFolder {
 public:
  // purpose: a word of its name. Throws FileError.
  explicit TemporaryFolder(const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace harness
