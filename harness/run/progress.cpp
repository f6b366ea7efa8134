#include "harness/run/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "harness/base/clock.h"
#include "harness/base/text.h"

namespace harness {
namespace {

// Of the terminal, less one: a line that fills it scrolls.
std::size_t columns() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::max<std::size_t>(known ? size.ws_col : 80, 20) - 1;
}

}  // namespace

Progress::Progress(std::ostream& out, bool terminal) : out_(out), terminal_(terminal) {}

void Progress::point(const PointResult& point, std::size_t search, std::size_t searches) {
  ++points_;
  std::string text = point.spec.id() + " ";
  text += point.ok() ? duration_text(point.seconds()) + "/s" : to_string(point.status);
  if (!terminal_) {
    out_ << "[" << search + 1 << "/" << searches << "] " << text;
    if (!point.ok()) out_ << " (" << point.detail << ")";
    out_ << std::endl;
    return;
  }
  bar((static_cast<double>(search) + 0.5) / static_cast<double>(searches), start_,
      std::to_string(points_) + " points", text);
}

void Progress::repetition(std::size_t done, std::size_t all) {
  if (terminal_) {
    if (repeating_since_ == std::chrono::steady_clock::time_point{})
      repeating_since_ = std::chrono::steady_clock::now();
    bar(static_cast<double>(done) / static_cast<double>(all), repeating_since_,
        "best points again, " + std::to_string(done) + " of " + std::to_string(all), "");
  } else if (done == all) {
    out_ << "repeated the best points, " << all << " runs" << std::endl;
  }
}

void Progress::bar(double fraction, std::chrono::steady_clock::time_point begin,
                   const std::string& head, const std::string& text) {
  constexpr std::size_t cells = 12;
  const auto filled = std::min(static_cast<std::size_t>(fraction * cells), cells);
  const double elapsed = since(begin);
  std::string line = "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "] " +
                     head + ", " + duration_text(since(start_));
  if (fraction > 0.02 && fraction < 1)
    line += ", about " + duration_text(elapsed * (1 - fraction) / fraction) + " left";
  line += "  " + text;
  line.resize(std::min(line.size(), columns()));
  const std::size_t width = line.size();
  if (width < width_) line.append(width_ - width, ' ');
  width_ = width;
  out_ << '\r' << line << std::flush;
}

void Progress::finish() {
  if (terminal_ && points_ > 0) out_ << '\r' << std::string(width_, ' ') << '\r' << std::flush;
}

}  // namespace harness
