#include "harness/run/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "harness/base/errors.h"
#include "harness/base/file_lock.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr const char* schema = "inextensible-journal/1";

// Not by opening the file again: closing that would give up the lock.
std::string content(int file) {
  std::string text;
  std::array<char, 65536> buffer{};
  for (ssize_t count;
       (count = pread(file, buffer.data(), buffer.size(), static_cast<off_t>(text.size()))) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  return text;
}

void check_header(const json& line) {
  if (line.value("schema", "") != schema) throw UsageError("it is not a journal of this program");
  for (const char* key : {"identity", "context"})
    if (!line.at(key).is_object()) throw UsageError(std::string("no ") + key);
  if (!line.at("context").at("date").is_string()) throw UsageError("no date");
}

// One line of a journal into memory.
void learn_line(const json& line, Memory& memory) {
  if (line.contains("point")) {
    const PointResult point = point_of(line.at("point"));
    memory.points[key_of(point.spec)] = {point, {}};
  } else if (line.contains("repeat")) {
    memory.points.at(line.at("repeat").get<std::string>())
        .repetitions.push_back(line.at("seconds").get<std::vector<double>>());
  } else {
    memory.points.erase(line.at("forget").get<std::string>());
  }
}

}  // namespace

void Memory::learn(const json& result) {
  for (const json& entry : result.at("points")) {
    PointResult point = point_of(entry);
    if (point.status == PointStatus::skipped) continue;
    point.best = point.best_at_error = false;  // to be decided again
    point.at_ladder_end.clear();
    Known known;
    for (std::size_t i = 1; i < point.samples.size(); ++i)
      known.repetitions.push_back({point.samples[i]});
    if (!point.samples.empty()) point.samples.resize(1);
    known.point = std::move(point);
    points[key_of(known.point.spec)] = std::move(known);
  }
}

void Memory::forget_failures() {
  std::erase_if(points, [](const auto& entry) { return !entry.second.point.ok(); });
}

json identity(const json& build_context, const json& suite, const json& selection) {
  const json& build = build_context.at("build");
  return {{"processor", build_context.at("cpu_model")},
          {"compiler", build.at("compiler")},
          {"compiler flags", build.at("flags")},
          {"program", build.value("binary", build.at("git").get<std::string>())},
          {"libraries", build_context.at("libraries")},
          {"suite", suite},
          {"selection", selection}};
}

std::string difference(const json& was, const json& is) {
  const json patch = json::diff(was, is);
  if (patch.empty()) return "";
  const json::json_pointer place(patch.at(0).at("path").get<std::string>());
  const auto text = [&place](const json& document) {
    return document.contains(place) ? value_text(document.at(place)) : std::string("not there");
  };
  std::string name = place.to_string().substr(1);
  return name + " is " + text(is) + ", was " + text(was);
}

Journal::Journal(const std::string& out) : out_(out), path_(out + ".journal") {
  lock();
  try {
    read();
  } catch (...) {
    close(file_);
    throw;
  }
}

Journal::~Journal() {
  if (file_ < 0) return;
  if (length_ == 0) unlink(path_.c_str());  // nothing has come of it
  close(file_);
}

void Journal::lock() {
  for (;;) {
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (file_ < 0) throw UsageError("cannot write '" + path_ + "': " + std::strerror(errno));
    if (!try_lock(file_)) {
      const pid_t other = lock_holder(file_);
      close(file_);
      throw UsageError("another bench" +
                       (other > 0 ? " (process " + std::to_string(other) + ")" : std::string()) +
                       " is writing '" + out_ + "'; give another --out");
    }
    struct stat status {};
    if (fstat(file_, &status) == 0 && status.st_nlink > 0) return;
    close(file_);  // its owner has just finished and removed it
  }
}

void Journal::read() {
  const std::string text = content(file_);
  std::size_t number = 0;
  // A last line without its end was being written when the program ended.
  for (std::size_t end; (end = text.find('\n', length_)) != std::string::npos; length_ = end + 1) {
    ++number;
    try {
      const json line = parse_line(text.substr(length_, end - length_), "no JSON");
      if (number == 1) {
        check_header(line);
        header_ = line;
      } else {
        learn_line(line, memory_);
      }
    } catch (const std::exception& error) {
      if (damage_.empty())
        damage_ = "line " + std::to_string(number) + ": " + shortened(error.what());
    }
  }
}

void Journal::start(const json& header) {
  if (ftruncate(file_, 0) != 0) throw FileError(path_, "empty");
  length_ = 0;
  memory_ = {};
  damage_.clear();
  header_ = header;
  header_["schema"] = schema;
  append(header_);
}

void Journal::add(const PointResult& point) { append({{"point", to_json(point)}}); }

void Journal::add_repetition(const std::string& key, const std::vector<double>& seconds) {
  append({{"repeat", key}, {"seconds", seconds}});
}

void Journal::forget(const std::string& key) { append({{"forget", key}}); }

void Journal::append(const json& line) {
  struct stat status {};
  if (fstat(file_, &status) != 0 || status.st_nlink == 0)
    throw FileError(path_, "go on writing", "it has been removed meanwhile");
  const std::string text = compact(line) + "\n";
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written =
        pwrite(file_, text.data() + done, text.size() - done, static_cast<off_t>(length_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    done += static_cast<std::size_t>(written);
  }
  if (done < text.size() || fdatasync(file_) != 0) {
    const std::string reason = std::strerror(errno);
    if (ftruncate(file_, static_cast<off_t>(length_)) != 0) {
    }  // a torn last line is understood, too
    throw FileError(path_, "write",
                    reason + "; what it holds is safe, --resume goes on from there");
  }
  length_ += text.size();
}

void Journal::remove() {
  unlink(path_.c_str());
  close(file_);
  file_ = -1;
}

namespace {

// A search for a stiffness goes another way from another start, where a neighbouring point failed
// then and does not now: its run is another one.
bool same_start(const PointResult& point, std::optional<double> guess) {
  if (!point.ok() || !point.stiffness) return true;
  return guess ? *guess == point.calibration_guess : std::isnan(point.calibration_guess);
}

}  // namespace

SweepRunners journaled(const SweepRunners& inner, Journal& journal, Memory memory) {
  const auto known = std::make_shared<Memory>(std::move(memory));
  SweepRunners runners;
  runners.references = inner.references;
  runners.run = [run = inner.run, known, &journal](const PointSpec& spec, const RunLimits& limits,
                                                   std::optional<double> guess) {
    const auto place = known->points.find(key_of(spec));
    if (place != known->points.end() && same_start(place->second.point, guess)) {
      if (limits.references)  // so that the result names it
        limits.references->find(spec.scene, spec.scene_parameters);
      return place->second.point;
    }
    PointResult point = run(spec, limits, guess);
    journal.add(point);
    return point;
  };
  runners.repeat = [repeat = inner.repeat, known, &journal](PointResult& point,
                                                            const RunLimits& limits) {
    const std::string key = key_of(point.spec);
    if (const auto place = known->points.find(key);
        place != known->points.end() && !place->second.repetitions.empty()) {
      const auto& seconds = place->second.repetitions.front();
      point.samples.insert(point.samples.end(), seconds.begin(), seconds.end());
      place->second.repetitions.pop_front();
      return;
    }
    const auto before = static_cast<std::ptrdiff_t>(point.samples.size());
    repeat(point, limits);
    journal.add_repetition(key, {point.samples.begin() + before, point.samples.end()});
  };
  return runners;
}

}  // namespace harness
