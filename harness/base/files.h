// Files read and written whole.
#pragma once

#include <stdexcept>
#include <string>

namespace harness {

// The disk is full, a folder is gone: "cannot write 'a.json': No space left on device".
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& path, const std::string& verb);  // the reason is errno's
  FileError(const std::string& path, const std::string& verb, const std::string& reason);
};

// Throws UsageError, with what the file is to the user, if it cannot be read.
std::string read_file(const std::string& path, const std::string& what);

// Throws UsageError unless a file can be made at `path`; makes missing folders. Nothing is left
// behind.
void check_writable(const std::string& path);

// Written beside, synced and renamed: the old file or the new one is there, never half of one.
// Throws FileError.
void write_atomically(const std::string& path, const std::string& text);

}  // namespace harness
