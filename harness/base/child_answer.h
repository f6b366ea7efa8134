// What a child process says of its work, as JSON: nothing that it writes ends its parent.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "harness/base/child_process.h"

namespace harness {

// What `read` makes of the answer; none where there is none. An answer that cannot be read (a
// solver's counter that is not a number, say) is how the child ended: outcome.end is then `threw`.
template <class Read>
auto answer(ChildOutcome& outcome, const Read& read)
    -> std::optional<std::invoke_result_t<Read, const nlohmann::json&>> {
  if (outcome.end != ChildOutcome::End::returned) return std::nullopt;
  try {
    return read(nlohmann::json::parse(outcome.text));
  } catch (const nlohmann::json::exception& error) {
    outcome.end = ChildOutcome::End::threw;
    outcome.text =
        std::string("its result cannot be read, is a number not finite? ") + error.what();
    return std::nullopt;
  }
}

}  // namespace harness
