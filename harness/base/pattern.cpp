#include "harness/base/pattern.h"

#include <re2/re2.h>

#include "harness/base/errors.h"
#include "harness/base/text.h"

namespace harness {

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
  std::vector<std::string> list{""};
  int round = 0;        // open parentheses
  bool square = false;  // inside [...]
  for (std::size_t i = 0; i < expression.size(); ++i) {
    const char c = expression[i];
    if (c == '|' && round == 0 && !square) {
      list.emplace_back();
      continue;
    }
    list.back() += c;
    if (c == '\\' && i + 1 < expression.size()) {
      list.back() += expression[++i];
    } else if (square) {
      square = c != ']';
    } else if (c == '[') {
      square = true;
    } else {
      round += c == '(' ? 1 : c == ')' ? -1 : 0;
    }
  }
  return list;
}

bool has_form(const std::string& text, const char* form) { return RE2::FullMatch(text, form); }

}  // namespace harness
