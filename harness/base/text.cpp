#include "harness/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>

namespace harness {

std::string number_text(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

double rounded_to(double value, int digits) {
  // Not std::stod, which throws on the smallest numbers.
  return std::strtod(number_text(value, digits).c_str(), nullptr);
}

std::string told_apart(double value, double other) {
  constexpr int all_digits = 17;
  int digits = 6;
  while (value != other && digits < all_digits &&
         number_text(value, digits) == number_text(other, digits))
    ++digits;
  return number_text(value, digits);
}

void append(std::string& list, const std::string& more, const char* separator) {
  list += (list.empty() ? "" : separator) + more;
}

std::string harmless(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](std::size_t k) -> unsigned {
      return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0;
    };
    const unsigned last = byte(2);
    std::size_t taken = 0;  // bytes of a character that is replaced
    if (byte(0) < 0x20 || byte(0) == 0x7F) taken = 1;
    if (byte(0) == 0xC2 && byte(1) >= 0x80 && byte(1) < 0xA0) taken = 2;  // U+0080 to U+009F
    // U+200B to U+200F, U+2028 to U+202E, U+2060 to U+206F, and the byte order mark.
    if (byte(0) == 0xE2 && byte(1) == 0x80 &&
        ((last >= 0x8B && last <= 0x8F) || (last >= 0xA8 && last <= 0xAE)))
      taken = 3;
    if (byte(0) == 0xE2 && byte(1) == 0x81 && last >= 0xA0 && last <= 0xAF) taken = 3;
    if (byte(0) == 0xEF && byte(1) == 0xBB && last == 0xBF) taken = 3;
    result += taken > 0 ? '?' : text[i];
    if (taken > 1) i += taken - 1;
  }
  return result;
}

std::string shortened(const std::string& text, std::size_t most) {
  const std::string line = harmless(text.substr(0, most));
  return text.size() > most ? line + "..." : line;
}

std::string fitted(const std::string& text, std::size_t columns) {
  constexpr std::size_t none = std::string::npos;
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    line.erase(line.find_last_not_of(' ') + 1);
    std::size_t begin = line.find_first_not_of(' ');  // no break before the first word
    while (line.size() > columns) {
      std::size_t at = line.rfind(' ', columns);
      while (at != none && at > begin && line[at + 1] == '%') at = line.rfind(' ', at - 1);
      if (at == none || at <= begin) at = line.find(' ', std::max(begin, columns));
      if (at == none) break;
      const std::size_t last = line.find_last_not_of(' ', at),
                        next = line.find_first_not_of(' ', at);
      // In a table below the column, if that leaves room.
      const std::size_t column = line.rfind("  ", last);
      const bool table =
          column != none && column > begin && column + 2 + line.size() - next <= columns;
      const std::size_t indent = table ? column + 2 : 2;
      result += line.substr(0, last + 1) + '\n';
      line = std::string(indent, ' ') + line.substr(next);
      begin = indent;
    }
    result += line + '\n';
  }
  return result;
}

std::string step_text(double step) { return std::isnan(step) ? "-" : "1/" + number_text(1 / step); }

std::string duration_text(double seconds) {
  if (seconds < 1) return number_text(1000 * seconds, 3) + " ms";
  if (seconds < 100) return number_text(seconds, 3) + " s";
  const long whole = std::lround(seconds);
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

std::string fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ULL;
  std::ostringstream hex;
  hex << std::hex << hash;
  return hex.str();
}

}  // namespace harness
