#include "harness/stability/trial_isolation.h"

#include "harness/base/child_answer.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/stability/trial_json.h"

namespace harness {
namespace {

using End = ChildOutcome::End;

// A trial looks at its own clock between steps; this is for steps that do not end.
constexpr double longest_trial = 150;  // s, both attempts

}  // namespace

TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed) {
  ChildOutcome child =
      run_in_child([&](Heartbeat&) { return compact(to_json(run_trial(build, solver, seed))); },
                   {longest_trial, 0, nullptr});
  if (const auto result = answer(child, trial_result_of)) return *result;
  TrialResult result;
  const bool stuck = child.end == End::timed_out;
  result.fixed = result.outcome = stuck ? Outcome::timeout : Outcome::crashed;
  result.detail =
      stuck ? "a step did not end within " + number_text(longest_trial) + " s" : ending(child);
  return result;
}

}  // namespace harness
