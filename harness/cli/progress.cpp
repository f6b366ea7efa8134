#include "harness/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "harness/base/clock.h"
#include "harness/base/text.h"

namespace harness {
namespace {

// Width of the terminal, less one: a line that fills it scrolls.
std::size_t columns() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return std::max<std::size_t>(known ? size.ws_col : 80, 20) - 1;
}

}  // namespace

Progress::Progress(std::ostream& out, bool terminal) : out_(out), terminal_(terminal) {}

void Progress::point(const PointResult& point, std::size_t search, std::size_t searches) {
  ++points_;
  const double fraction = (static_cast<double>(search) + 0.5) / static_cast<double>(searches);
  const std::string head = std::to_string(points_) + " points";
  if (terminal_) {
    bar(fraction, start_, head,
        point.spec.id() + " " +
            (point.ok() ? duration_text(point.seconds()) + "/s" : to_string(point.status)));
  } else if (worth_a_line(fraction)) {
    out_ << state(fraction, start_, head) << ": at " << point.spec.id() << std::endl;
  }
}

void Progress::repetition(std::size_t done, std::size_t all) {
  if (repeating_since_ == std::chrono::steady_clock::time_point{}) {
    repeating_since_ = std::chrono::steady_clock::now();
    lines_ = 0;
  }
  const double fraction = static_cast<double>(done) / static_cast<double>(all);
  const std::string head =
      "best points again, " + std::to_string(done) + " of " + std::to_string(all);
  if (terminal_) {
    bar(fraction, repeating_since_, head, "");
  } else if (worth_a_line(fraction)) {
    out_ << state(fraction, repeating_since_, head) << std::endl;
  }
}

bool Progress::worth_a_line(double fraction) {
  constexpr int most = 20;  // in each of the two parts
  if (fraction * most < lines_) return false;
  ++lines_;
  return true;
}

std::string Progress::state(double fraction, std::chrono::steady_clock::time_point begin,
                            const std::string& head) const {
  std::string text = head + ", " + duration_text(since(start_));
  if (fraction > 0.02 && fraction < 1)
    text += ", about " + duration_text(since(begin) * (1 - fraction) / fraction) + " left";
  return text;
}

void Progress::bar(double fraction, std::chrono::steady_clock::time_point begin,
                   const std::string& head, const std::string& text) {
  constexpr std::size_t cells = 12;
  const auto filled = std::min(static_cast<std::size_t>(fraction * cells), cells);
  std::string line = "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "] " +
                     state(fraction, begin, head) + "  " + text;
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
