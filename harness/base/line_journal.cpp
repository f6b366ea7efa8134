#include "harness/base/line_journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "harness/base/errors.h"
#include "harness/base/file_lock.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"

namespace harness {
namespace {

using nlohmann::json;

// Not by opening the file again: closing that would give up the lock.
std::string content(int file) {
  std::string text;
  std::array<char, 65536> buffer{};
  for (ssize_t count;
       (count = pread(file, buffer.data(), buffer.size(), static_cast<off_t>(text.size()))) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  return text;
}

}  // namespace

LineJournal::LineJournal(const std::string& out) : path_(out + ".journal") { lock(out); }

LineJournal::~LineJournal() {
  if (file_ < 0) return;
  if (length_ == 0) unlink(path_.c_str());  // nothing has come of it
  close(file_);
}

void LineJournal::lock(const std::string& out) {
  for (;;) {
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (file_ < 0) throw UsageError("cannot write '" + path_ + "': " + std::strerror(errno));
    if (!try_lock(file_)) {
      const pid_t other = lock_holder(file_);
      close(file_);
      throw UsageError("another bench" +
                       (other > 0 ? " (process " + std::to_string(other) + ")" : std::string()) +
                       " is writing '" + out + "'; give another --out");
    }
    struct stat status {};
    if (fstat(file_, &status) == 0 && status.st_nlink > 0) return;
    close(file_);  // its owner has just finished and removed it
  }
}

void LineJournal::read(const std::function<void(const json&, std::size_t)>& learn) {
  const std::string text = content(file_);
  std::size_t number = 0;
  // A last line without its end was being written when the program ended.
  for (std::size_t end; (end = text.find('\n', length_)) != std::string::npos; length_ = end + 1) {
    ++number;
    try {
      learn(parse_line(text.substr(length_, end - length_), "no JSON"), number);
    } catch (const std::exception& error) {
      if (damage_.empty())
        damage_ = "line " + std::to_string(number) + ": " + shortened(error.what());
    }
  }
}

void LineJournal::start(const json& header) {
  if (ftruncate(file_, 0) != 0) throw FileError(path_, "empty");
  length_ = 0;
  damage_.clear();
  append(header);
}

void LineJournal::append(const json& line) {
  struct stat status {};
  if (fstat(file_, &status) != 0 || status.st_nlink == 0)
    throw FileError(path_, "continue", "it has been removed meanwhile");
  const std::string text = compact(line) + "\n";
  if (lseek(file_, static_cast<off_t>(length_), SEEK_SET) < 0 || !write_whole(file_, text) ||
      fdatasync(file_) != 0) {
    const std::string reason = std::strerror(errno);
    if (ftruncate(file_, static_cast<off_t>(length_)) != 0) {
    }  // a torn last line is understood, too
    throw FileError(path_, "write", reason + "; its lines are safe, --resume continues from there");
  }
  length_ += text.size();
}

void LineJournal::remove() {
  unlink(path_.c_str());
  close(file_);
  file_ = -1;
}

}  // namespace harness
