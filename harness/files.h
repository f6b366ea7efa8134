// Files read and written whole.
#pragma once

#include <string>

namespace harness {

// Throws UsageError, with what the file is to the user, if it cannot be read.
std::string read_file(const std::string& path, const std::string& what);

// Throws UsageError unless a file can be made at `path`; makes missing folders. Nothing is left
// behind.
void check_writable(const std::string& path);

// Written beside, synced and renamed: the old file or the new one is there, never half of one.
void write_atomically(const std::string& path, const std::string& text);

}  // namespace harness
