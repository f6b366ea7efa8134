// Regular expressions of users in RE2's syntax, whose time is proportional to the text.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace re2 {
class RE2;
}

namespace harness {

// Letters match whatever their case.
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

}  // namespace harness
