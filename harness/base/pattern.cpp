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

}  // namespace harness
