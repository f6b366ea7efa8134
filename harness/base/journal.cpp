#include "harness/base/journal.h"

#include <fcntl.h>
#include <sys/stat.h>

#include "harness/base/json.h"
#include "harness/base/text.h"

namespace harness {
namespace {

std::string check_of(const json& line) { return fnv1a(compact(line)); }

}  // namespace

Journal::Journal(const std::string& out) : path_(out + ".journal") {
  lock(out);
  read();
}

Journal::~Journal() {
  if (file_ && length_ == 0) unlink(path_.c_str());  // nothing was recorded
}

void Journal::lock(const std::string& out) {
  for (struct stat status{}; status.st_nlink == 0;) {  // 0: its owner removed it meanwhile
    file_ = OpenFile(open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (!file_) throw UsageError("cannot write '" + path_ + "': " + std::strerror(errno));
    if (!try_lock(file_.get())) {
      const pid_t other = lock_holder(file_.get());
      throw UsageError("another bench" +
                       (other > 0 ? " (process " + std::to_string(other) + ")" : std::string()) +
                       " is writing '" + out + "'; give another --out");
    }
    fstat(file_.get(), &status);
  }
}

void Journal::read() {
  // Not by opening the file again: closing that would give up the lock.
  const std::string text = read_whole(file_.get());
  std::size_t number = 0;
  // A last line without its end was being written when the program ended.
  for (std::size_t end; (end = text.find('\n', length_)) != std::string::npos; length_ = end + 1) {
    ++number;
    try {
      json line = parse_document(text.substr(length_, end - length_), "it");
      const json check = line.value("check", json());
      line.erase("check");
      if (check != check_of(line)) throw UsageError("it is not as it was written");
      if (line.contains("header")) {
        header_ = line["header"];
        damage_.clear();
      } else if (line.contains("forget")) {
        known_.erase(line.at("forget").get<std::string>());
      } else {
        known_[line.at("key").get<std::string>()] = std::move(line.at("value"));
      }
    } catch (const std::exception& error) {
      if (damage_.empty())
        damage_ = "line " + std::to_string(number) + ": " + shortened(error.what());
    }
  }
}

const json* Journal::find(const std::string& key) const {
  const auto place = known_.find(key);
  return place == known_.end() ? nullptr : &place->second;
}

void Journal::start(const json& header) {
  if (ftruncate(file_.get(), 0) != 0) throw FileError(path_, "empty");
  length_ = 0;
  known_.clear();
  go_on(header);
}

void Journal::go_on(const json& header) {
  header_ = header;
  damage_.clear();
  append({{"header", header}});
}

const json& Journal::add(const std::string& key, json value) {
  append({{"key", key}, {"value", value}});
  return known_[key] = std::move(value);
}

const json& Journal::once(const std::string& key, const std::function<json()>& compute) {
  const json* known = find(key);
  return known ? *known : add(key, compute());
}

void Journal::forget(const std::string& key) {
  if (known_.erase(key) > 0) append({{"forget", key}});
}

void Journal::append(json line) {
  struct stat status {};
  if (fstat(file_.get(), &status) != 0 || status.st_nlink == 0)
    throw FileError(path_, "continue", "it has been removed meanwhile");
  line["check"] = check_of(line);
  const std::string text = compact(line) + "\n";
  if (lseek(file_.get(), static_cast<off_t>(length_), SEEK_SET) < 0 ||
      !write_whole(file_.get(), text) || fdatasync(file_.get()) != 0) {
    const std::string reason = std::strerror(errno);
    if (ftruncate(file_.get(), static_cast<off_t>(length_)) != 0) {
    }  // a torn last line is understood, too
    throw FileError(path_, "write", reason + "; its lines are safe, --resume continues from there");
  }
  length_ += text.size();
}

void Journal::remove() {
  unlink(path_.c_str());
  file_ = OpenFile();
}

}  // namespace harness
