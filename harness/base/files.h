// Files read and written whole. Everything that this program leaves on a disk is opened here, but
// for journals, which are written a line at a time.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace harness {

// The disk is full, a folder is gone: "cannot write 'a.json': No space left on device".
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& path, const std::string& verb,
            const std::string& reason = std::strerror(errno));
};

// A file descriptor, closed at the end; negative: none.
class OpenFile {
 public:
  explicit OpenFile(int file = -1) : file_(file) {}
  ~OpenFile() {
    if (file_ >= 0) close(file_);
  }
  OpenFile(OpenFile&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  int get() const { return file_; }
  explicit operator bool() const { return file_ >= 0; }

 private:
  int file_;
};

// All of the text to an open file, from where it stands. False if it cannot; the reason is errno's.
bool write_whole(int file, const std::string& text);

// Throws UsageError, with what the file is to the user, if it cannot be read.
std::string read_file(const std::string& path, const std::string& what);

// Where writing to `path` ends up: symbolic links followed, of a file that is yet to be made too.
// Two names of one output are one, so locks hold. Throws UsageError for "", a folder, and links in
// a circle.
std::string output_path(const std::string& path);

// As output_path, and a regular file: what is written with a journal beside it, and found again
// later. Throws UsageError for devices, pipes and "-" too.
std::string regular_output_path(const std::string& path);

// Throws UsageError unless something can be written at `path`; makes missing folders. Nothing is
// left behind and no other file is touched.
void check_writable(const std::string& path);

// A regular file is written beside, synced and renamed: the old one or the new one is there, never
// half of one, and a link to it stays a link. Devices and pipes are written to; "-" is standard
// output. Throws FileError.
void write_atomically(const std::string& path, const std::string& text);

// Removes temporary folders whose process is gone.
void remove_left_folders();

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

// Whether the lock is held now; does not wait.
bool try_lock(int file);
// The process that holds it; 0 if none does, or it cannot be seen from here.
pid_t lock_holder(int file);

}  // namespace harness
