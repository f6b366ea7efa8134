// Small runs (hard cases, known answers, checks of a solver), each in a child process of its own,
// and what a plan of them is told.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/base/child_process.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"

namespace harness {

struct RunEvents {
  std::function<bool()> interrupted = [] { return false; };
  // Gives what is known under a key, or what `compute` returns (Journal::once).
  std::function<nlohmann::json(const std::string& key,
                               const std::function<nlohmann::json()>& compute)>
      once = [](const std::string&, const auto& compute) { return compute(); };
  std::function<void(const std::string& key, std::size_t done, std::size_t all)> done =
      [](auto&&...) {};
};

// What `read` makes of the JSON that `work` returns in a child, or what `lost` makes of the way in
// which the child ended without it. Throws Interrupted.
template <class Read, class Lost>
auto in_child(const ChildLimits& limits, const std::function<nlohmann::json(Heartbeat&)>& work,
              const Read& read, const Lost& lost) {
  ChildOutcome child =
      run_in_child([&](Heartbeat& heartbeat) { return compact(work(heartbeat)); }, limits);
  if (child.end == ChildOutcome::End::interrupted) throw Interrupted();
  const auto result = answer(child, read);
  return result ? *result : lost(child);
}

}  // namespace harness
