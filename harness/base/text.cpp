#include "harness/base/text.h"

#include <re2/re2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <numeric>

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
  static const RE2 signs(
      R"([\x00-\x1f\x7f-\x{9f}\x{200b}-\x{200f}\x{2028}-\x{202e}\x{2060}-\x{206f}\x{feff}])");
  std::string result = text;
  RE2::GlobalReplace(&result, signs, "?");
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

Pattern::Pattern(const std::string& option, const std::string& text) {
  RE2::Options options;
  options.set_case_sensitive(false);
  options.set_log_errors(false);
  expression_ = std::make_shared<const RE2>(text, options);
  if (!expression_->ok())
    throw UsageError(option + " '" + shortened(text) +
                     "' is not a regular expression: " + shortened(expression_->error()));
}

bool Pattern::matches(const std::string& text) const { return RE2::FullMatch(text, *expression_); }

bool Pattern::found_in(const std::string& text) const {
  return RE2::PartialMatch(text, *expression_);
}

std::vector<std::string> alternatives(const std::string& expression) {
  // An escaped character, a set, or a character. Latin-1: one byte each.
  static const RE2 token(R"((?s)(\\.|\[(?:\\.|[^\]\\])*\]|.))", RE2::Latin1);
  std::vector<std::string> list{""};
  int open = 0;  // parentheses
  re2::StringPiece rest(expression);
  for (std::string part; RE2::Consume(&rest, token, &part);) {
    open += part == "(" ? 1 : part == ")" ? -1 : 0;
    if (part == "|" && open == 0)
      list.emplace_back();
    else
      list.back() += part;
  }
  return list;
}

bool has_form(const std::string& text, const char* form) { return RE2::FullMatch(text, form); }

namespace {

constexpr std::size_t longest_message = 600;
constexpr std::size_t longest_name = 200;  // that is compared with others

// Levenshtein distance, for names of a few letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substitute});
    }
  }
  return row.back();
}

}  // namespace

UsageError::UsageError(const std::string& message)
    : std::runtime_error(shortened(message, longest_message)) {}

std::string closest(std::string_view name, const std::vector<std::string>& known) {
  name = name.substr(0, longest_name);
  std::string best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const bool prefix = name.size() >= 2 && candidate.starts_with(name);
    const std::size_t edits = edit_distance(name, candidate);
    const std::size_t distance = prefix ? std::min<std::size_t>(edits, 2) : edits;
    if (distance >= least) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

UsageError unknown_name(std::string_view kind, std::string_view name,
                        const std::vector<std::string>& known) {
  std::string message = "no " + std::string(kind) + " '" + shortened(std::string(name)) + "'";
  const std::string best = closest(name, known);
  if (!best.empty()) message += "; did you mean '" + best + "'?";
  message += " (known: ";
  for (std::size_t i = 0; i < known.size(); ++i) message += (i ? ", " : "") + known[i];
  return UsageError(message + ")");
}

void check_known(std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known, const std::string& where) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw UsageError((where.empty() ? "" : where + ": ") + unknown_name(kind, name, known).what());
}

}  // namespace harness
