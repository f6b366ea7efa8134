// What a reader says when it refuses its input.
#pragma once

#include <gtest/gtest.h>

#include "harness/base/text.h"

namespace harness {

// The message of the refusal, "" if nothing was refused.
template <class Read>
std::string refusal_of(const Read& read) {
  try {
    read();
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

// Whether `read` refuses its input, with `part` in what it says.
template <class Read>
::testing::AssertionResult refuses(const Read& read, const std::string& part) {
  const std::string said = refusal_of(read);
  const bool named = !said.empty() && said.find(part) != said.npos;
  return (named ? ::testing::AssertionSuccess() : ::testing::AssertionFailure()) << said;
}

}  // namespace harness
