// Files read and written as a whole: everything that this program leaves on a disk but journals.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace harness {

// A full disk or a missing folder: "cannot write 'a.json': No space left on device".
struct FileError : std::runtime_error {
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

// Writes all of the text at the current position. False if that fails; errno has the reason.
bool write_whole(int file, const std::string& text);
// Its content from the beginning on, wherever the current position is.
std::string read_whole(int file);

// what: the role of the file ("suite"), for messages. Throws UsageError if it cannot be read.
std::string read_file(const std::string& path, const std::string& what);

// The file that writing to `path` changes: links are followed, even to a file that does not exist
// yet, so that two names share a lock. Throws UsageError for "", a folder, and circular links.
std::string output_path(const std::string& path);

// The same for an output with a journal. Throws UsageError for devices, pipes and "-" too.
std::string regular_output_path(const std::string& path);

// Throws UsageError unless `path` can be written. No file is left, and no folder is made.
void check_writable(const std::string& path);

// Replaces a regular file by a temporary file in the same folder, which is written, synced and
// renamed: the old or the new file is there, never a part of one, and a link stays a link. Devices
// and pipes are written to; "-" is standard output. Throws FileError.
void write_atomically(const std::string& path, const std::string& text);

// Removes the temporary folders of processes that have ended.
void remove_left_folders();

class TemporaryFolder {
 public:
  // purpose: a word for its name. Throws FileError.
  explicit TemporaryFolder(const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// Takes the lock without waiting; whether this process holds it now.
bool try_lock(int file);
// The process that holds the lock; 0 if none does or it is not visible from here.
pid_t lock_holder(int file);

// ---- Standard input, output and error as a program may find them: closed, full, cut off ----

// Opens those of descriptors 0 to 2 that are closed, so that no file that is opened later becomes
// one of them and messages are written into it. First thing in main.
void open_standard_streams();

// While it lives, what is written to standard output goes to standard error: what foreign code
// prints is not mixed with a result. Throws FileError if there is no descriptor left.
class OutputToError {
 public:
  OutputToError();
  ~OutputToError();

 private:
  OpenFile output_;
};

// The same to the end of this process.
void send_output_to_error();

// Columns of the terminal that standard output (or another stream) is; 120 where it is none.
std::size_t output_columns(int file = 1);

// Throws FileError if something that was printed did not get out. Last thing in main.
void check_standard_output();

// ---- Where the program finds what comes with it, and where results go ----

// Whether the program runs from where it was installed, and not from a build folder.
bool is_installed();
// A file that comes with the program, named as in the source tree, wherever it is installed.
std::string source_path(const std::string& relative);
// A shared library that comes with the program; "" if there is none.
std::string library_path(const std::string& name);
// The default place of results: results/local of the source tree; installed, of the current folder.
std::string local_result(const std::string& name);
// The same place, which is not created.
std::string local_place(const std::string& name);

}  // namespace harness
