// What came of a trial, as JSON both ways: between processes, in journals and in result files.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/base/fields_json.h"
#include "harness/stability/trial.h"

namespace harness {

template <>
struct FieldCodec<Outcome> {
  static nlohmann::json write(Outcome outcome, bool nullable);
  // Throws json::exception for what is no outcome.
  static void read(const nlohmann::json& from, Outcome& outcome, bool nullable);
};

inline constexpr std::tuple trial_fields{
    field("outcome", &TrialResult::outcome, "", "with smaller steps where its own was refused"),
    field("at_fixed_step", &TrialResult::fixed, "", "at the trial's own step"),
    field("detail", &TrialResult::detail, "", "of a failure: step, reason, worst edge"),
    field("smallest_step", &TrialResult::smallest_step, "s", "accepted by the step controller",
          {.nullable = true}),
    field("max_strain", &TrialResult::max_strain, "",
          "after any accepted step, before the collision filter", {.nullable = true}),
    field("strain_first_second", &TrialResult::strain_first_second, "",
          "the same within the first simulated second", {.nullable = true}),
    field("strain_last_second", &TrialResult::strain_last_second, "",
          "the same within the last one", {.nullable = true}),
    field("energy_gain", &TrialResult::energy_gain, "scale", "largest E - E_0", {.nullable = true}),
    field("momentum_defect", &TrialResult::momentum_defect, "", "largest, relative",
          {.nullable = true}),
    field("reciprocal_condition", &TrialResult::reciprocal_condition, "",
          "worst of the linear systems", {.nullable = true}),
    field("seconds", &TrialResult::seconds, "s", "wall, both attempts")};

nlohmann::json to_json(const TrialResult& result);
TrialResult trial_result_of(const nlohmann::json& object);

}  // namespace harness
