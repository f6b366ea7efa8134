// What a reader says when it refuses its input.
#pragma once

#include "harness/base/errors.h"

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

}  // namespace harness
