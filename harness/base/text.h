// Numbers and texts as people read them, messages about bad input, and the regular expressions
// that people type.
#pragma once

#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace re2 {
class RE2;
}

namespace harness {

// All parts in one text; numbers as number_text() writes them.
template <class... Parts>
std::string concat(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

// "1 face", "2 faces".
template <class Number>
std::string counted(Number count, const std::string& one, const std::string& many = "") {
  return concat(count, ' ', count == 1 ? one : many.empty() ? one + "s" : many);
}

// With this many significant digits and no trailing zeros; six is the default of streams.
std::string number_text(double value, int digits = 6);

double rounded_to(double value, int digits = 6);

// With as many digits, six or more, as set it apart from `other`: "0.00010000002" against 0.0001.
std::string told_apart(double value, double other);

// `more` at the end of a list, after a separator unless it is the first.
void append(std::string& list, const std::string& more, const char* separator = ", ");

// A text from elsewhere as it can be printed: '?' for each character that controls a terminal or
// the direction of writing, or is invisible (UTF-8).
std::string harmless(const std::string& text);

// A harmless text shortened for a message: its beginning if it is long, and always one line.
std::string shortened(const std::string& text, std::size_t most = 120);

// Breaks lines longer than `columns` at spaces and indents the rest; longer words stay whole.
std::string fitted(const std::string& text, std::size_t columns);

// "1/250" for a step of 0.004 s, "-" for none (NaN).
std::string step_text(double step);

// "12 ms", "1.5 s", "2 min 5 s".
std::string duration_text(double seconds);

// A short hash (FNV-1a, 64 bits) that is the same on every machine, in hexadecimal.
std::string fnv1a(const std::string& text);

// A regular expression of a user, in RE2's syntax, whose time is proportional to the text. Letters
// match whatever their case.
class Pattern {
 public:
  // Throws UsageError, naming the option, if it is not a regular expression.
  Pattern(const std::string& option, const std::string& text);

  bool matches(const std::string& text) const;   // from its beginning to its end
  bool found_in(const std::string& text) const;  // anywhere

 private:
  std::shared_ptr<const re2::RE2> expression_;
};

// The alternatives at the top level: "shake|icd" has two, "(a|b)c" is one.
std::vector<std::string> alternatives(const std::string& expression);

// Whether the whole text has this form; the expression is the program's own.
bool has_form(const std::string& text, const char* form);

// ---- Bad input: one clear line for the user, exit 2 ----

class UsageError : public std::runtime_error {
 public:
  // One line, whatever names and values it holds, and not a long one.
  explicit UsageError(const std::string& message);
};

// The known name that a mistyped one is nearest to; empty if none is near.
std::string closest(std::string_view name, const std::vector<std::string>& known);

// "no solver 'fast'; did you mean 'fast_projection'? (known: a, b, c)"
[[nodiscard]] UsageError unknown_name(std::string_view kind, std::string_view name,
                                      const std::vector<std::string>& known);

// Throws unknown_name() unless `name` is known. where: begins the message; may be empty.
void check_known(std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known, const std::string& where = "");

template <class Infos>
std::vector<std::string> names_of(const Infos& infos) {
  std::vector<std::string> names;
  names.reserve(infos.size());
  for (const auto& info : infos) names.emplace_back(info.name);
  return names;
}

}  // namespace harness
