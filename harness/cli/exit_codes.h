#pragma once

namespace harness {

// docs/using.md explains them.
enum ExitCode {
  success = 0,
  internal_error = 1,
  usage_error = 2,
  regression = 3,
  unexpected_outcome = 4,
  not_comparable = 5,
  cannot_decide = 6,
  interrupted_exit = 130
};

}  // namespace harness
