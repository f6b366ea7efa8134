#include "harness/base/files.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "build_info.h"  // made by CMake
#include "harness/base/text.h"

namespace harness {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;  // Linux's limit

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// "-", or another name of standard output (/dev/stdout): its file is open and must stay.
bool is_standard_output(const std::string& path) {
  struct stat named {
  }, open{};
  return path == "-" || (stat(path.c_str(), &named) == 0 && fstat(STDOUT_FILENO, &open) == 0 &&
                         named.st_dev == open.st_dev && named.st_ino == open.st_ino);
}

// A device or pipe.
bool is_special(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

// Removes what killed processes left: entries whose names are the stem, their number, and more.
void remove_left(const fs::path& folder, const std::string& stem) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(stem)) continue;
    const pid_t owner = std::atoi(name.c_str() + stem.size());
    if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH) fs::remove_all(entry, ignored);
  }
}

// A new file beside `path`, created exclusively under a unique name; no link is followed.
class Beside {
 public:
  explicit Beside(const std::string& path)
      : name_(path + mark + std::to_string(getpid()) + ".XXXXXX"),
        file_(mkostemp(name_.data(), O_CLOEXEC)) {}
  ~Beside() {
    if (file_ && !kept_) unlink(name_.c_str());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  static void remove_left_of(const fs::path& path) {
    remove_left(folder_of(path), path.filename().string() + mark);
  }

  bool made() const { return static_cast<bool>(file_); }  // false: errno says why

  // Takes the place of `path` with this text and the permissions of the old file, or a new one's.
  bool replace(const std::string& path, const std::string& text) {
    struct stat status {};
    const mode_t mode = stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : new_file_mode();
    kept_ = write_whole(file_.get(), text) && fchmod(file_.get(), mode) == 0 &&
            fsync(file_.get()) == 0 && rename(name_.c_str(), path.c_str()) == 0;
    return kept_;
  }

 private:
  static mode_t new_file_mode() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
  }

  static constexpr const char* mark = ".new-";

  std::string name_;
  OpenFile file_;
  bool kept_ = false;
};

// error: errno of the attempt; 0 if the file was opened and is empty.
std::string unreadable_because(const std::string& path, int error) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return "it is a folder";
  if (fs::is_symlink(path, unknown) && !fs::exists(path, unknown))
    return "it is a link to '" + fs::read_symlink(path, unknown).string() +
           "', which does not exist";
  return error == 0 ? "it is empty" : std::strerror(error);
}

std::string temporary_stem() { return "bench-" + std::to_string(getuid()) + "-"; }

flock whole_file() {
  flock region{};
  region.l_type = F_WRLCK;
  region.l_whence = SEEK_SET;
  return region;
}

// The share folder beside an installed program, "" for one in a build folder.
fs::path program_folder() {
  std::error_code error;  // no such file: an empty path
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

const std::string& share_folder() {
  static const std::string folder = [] {
    std::error_code error;
    const fs::path share = (program_folder() / INEXTENSIBLE_DATA_FROM_PROGRAM).lexically_normal();
    return fs::is_directory(share / "configs", error) ? share.string() : std::string();
  }();
  return folder;
}

}  // namespace

FileError::FileError(const std::string& path, const std::string& verb, const std::string& reason)
    : std::runtime_error("cannot " + verb + " '" + path + "': " + reason) {}

bool write_whole(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<std::size_t>(written);
  }
  return true;
}

std::string read_whole(int file) {
  std::string text;
  std::array<char, 65536> buffer{};
  for (ssize_t count;
       (count = pread(file, buffer.data(), buffer.size(), static_cast<off_t>(text.size()))) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  return text;
}

std::string read_file(const std::string& path, const std::string& what) {
  errno = 0;
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw UsageError("cannot read the " + what + " '" + path +
                     "': " + unreadable_because(path, errno));
  return text.str();
}

std::string output_path(const std::string& path) {
  if (is_standard_output(path)) return path;
  if (path.empty()) throw UsageError("'' is not a file name; --out takes one");
  fs::path place(path);
  std::error_code error;
  for (int link = 0; fs::is_symlink(place, error) && !is_special(place); ++link) {
    if (link == most_links) throw UsageError("'" + path + "' is a link in a circle");
    const fs::path next = fs::read_symlink(place, error);
    if (error) throw UsageError("cannot follow the link '" + path + "': " + error.message());
    place = folder_of(place) / next;  // an absolute path replaces the folder
  }
  if (fs::is_directory(place, error))
    throw UsageError("'" + path + "' is a folder; --out names a file");
  // Programs that are given the name take it for an option otherwise.
  return (place.string().front() == '-' ? "./" : "") + place.string();
}

std::string regular_output_path(const std::string& path) {
  std::string place = output_path(path);
  if (is_standard_output(place) || is_special(place))
    throw UsageError("'" + path + "' is not a regular file; --out names one to keep");
  return place;
}

void check_writable(const std::string& path) {
  const std::string place = output_path(path);
  if (is_standard_output(place)) return;
  const fs::path folder = folder_of(place);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw UsageError("cannot write '" + path + "': there is no folder '" + folder.string() + "'");
  Beside::remove_left_of(place);
  const bool writable = is_special(place) ? access(place.c_str(), W_OK) == 0 : Beside(place).made();
  if (!writable) throw UsageError("cannot write '" + path + "': " + std::strerror(errno));
}

void write_atomically(const std::string& path, const std::string& text) {
  const std::string place = output_path(path);
  if (is_standard_output(place)) {
    std::cout << text << std::flush;  // whether that went well, main says
  } else if (is_special(place)) {
    const OpenFile file(open(place.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (!file || !write_whole(file.get(), text)) throw FileError(path, "write");
  } else {
    Beside beside(place);
    if (!beside.made() || !beside.replace(place, text)) throw FileError(path, "write");
  }
}

void remove_left_folders() { remove_left(fs::temp_directory_path(), temporary_stem()); }

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  remove_left_folders();
  const std::string stem = temporary_stem() + std::to_string(getpid()) + "-" + purpose;
  std::string name = (fs::temp_directory_path() / (stem + "-XXXXXX")).string();
  if (!mkdtemp(name.data())) throw FileError(name, "make");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

bool try_lock(int file) {
  flock region = whole_file();
  return fcntl(file, F_SETLK, &region) == 0;
}

pid_t lock_holder(int file) {
  flock region = whole_file();
  return fcntl(file, F_GETLK, &region) == 0 && region.l_type != F_UNLCK ? region.l_pid : 0;
}

void open_standard_streams() {
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond `ulimit -f` fails like any other
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free number is this one. It is opened in the wrong direction, so that use fails.
    const int opened = open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (opened != descriptor) _exit(1);  // no way to say why
  }
}

std::size_t output_columns(int file) {
  constexpr std::size_t usual = 120, least = 40;
  winsize size{};
  const bool known = ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? std::max<std::size_t>(size.ws_col, least) : usual;
}

void check_standard_output() {
  errno = 0;
  std::cout.flush();
  if (std::cout) return;
  throw FileError("standard output", "write to",
                  errno != 0 ? std::strerror(errno) : "it is closed or full");
}

// std::cout as well: it writes through stdout's buffer.
void send_output_to_error() {
  std::cout.flush();
  std::fflush(stdout);
  dup2(STDERR_FILENO, STDOUT_FILENO);
}

OutputToError::OutputToError() : output_(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)) {
  if (!output_) throw FileError("standard output", "redirect");
  send_output_to_error();
}

OutputToError::~OutputToError() {
  std::cout.flush();
  std::fflush(stdout);
  dup2(output_.get(), STDOUT_FILENO);
}

bool is_installed() { return !share_folder().empty(); }

std::string source_path(const std::string& relative) {
  return (share_folder().empty() ? INEXTENSIBLE_SOURCE_DIR : share_folder()) + "/" + relative;
}

std::string library_path(const std::string& name) {
  for (const char* place : {"", INEXTENSIBLE_LIBRARIES_FROM_PROGRAM}) {
    const fs::path library = (program_folder() / place / name).lexically_normal();
    if (std::error_code error; fs::is_regular_file(library, error)) return library;
  }
  return "";
}

std::string local_place(const std::string& name) {
  const std::string folder = "results/local";
  return (is_installed() ? folder : source_path(folder)) + "/" + name;
}

std::string local_result(const std::string& name) {
  std::string place = local_place(name);
  std::error_code error;  // the write that follows reports what is wrong
  std::filesystem::create_directories(std::filesystem::path(place).parent_path(), error);
  return place;
}

}  // namespace harness
