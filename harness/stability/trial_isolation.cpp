#include "harness/stability/trial_isolation.h"

#include "harness/base/child_answer.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;
using End = ChildOutcome::End;

json pack(const TrialResult& r) {
  return {{"fixed", static_cast<int>(r.fixed)},
          {"outcome", static_cast<int>(r.outcome)},
          {"detail", r.detail},
          {"smallest_step", number(r.smallest_step)},
          {"max_strain", number(r.max_strain)},
          {"strain_first_second", number(r.strain_first_second)},
          {"strain_last_second", number(r.strain_last_second)},
          {"energy_gain", number(r.energy_gain)},
          {"momentum_defect", number(r.momentum_defect)},
          {"reciprocal_condition", number(r.reciprocal_condition)},
          {"seconds", r.seconds},
          {"work", to_json(r.work)}};
}

TrialResult unpack(const json& j) {
  TrialResult r;
  r.fixed = static_cast<Outcome>(j.at("fixed").get<int>());
  r.outcome = static_cast<Outcome>(j.at("outcome").get<int>());
  j.at("detail").get_to(r.detail);
  r.smallest_step = number_of(j.at("smallest_step"));
  r.max_strain = number_of(j.at("max_strain"));
  r.strain_first_second = number_of(j.at("strain_first_second"));
  r.strain_last_second = number_of(j.at("strain_last_second"));
  r.energy_gain = number_of(j.at("energy_gain"));
  r.momentum_defect = number_of(j.at("momentum_defect"));
  r.reciprocal_condition = number_of(j.at("reciprocal_condition"));
  j.at("seconds").get_to(r.seconds);
  r.work = work_of(j.at("work"));
  return r;
}

// A trial looks at its own clock between steps; this is for steps that do not end.
constexpr double longest_trial = 150;  // s, both attempts

}  // namespace

TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed) {
  ChildOutcome child =
      run_in_child([&](Heartbeat&) { return compact(pack(run_trial(build, solver, seed))); },
                   {longest_trial, 0, nullptr});
  if (const auto result = answer(child, unpack)) return *result;
  TrialResult result;
  const bool stuck = child.end == End::timed_out;
  result.fixed = result.outcome = stuck ? Outcome::timeout : Outcome::crashed;
  result.detail =
      stuck ? "a step did not end within " + number_text(longest_trial) + " s" : ending(child);
  return result;
}

}  // namespace harness
