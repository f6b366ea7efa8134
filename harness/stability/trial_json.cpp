#include "harness/stability/trial_json.h"

#include <string>

#include "harness/points/point_json.h"

namespace harness {

using nlohmann::json;

json FieldCodec<Outcome>::write(Outcome outcome, bool /*nullable*/) { return to_string(outcome); }

void FieldCodec<Outcome>::read(const json& from, Outcome& outcome, bool /*nullable*/) {
  const std::string text = from.get<std::string>();
  for (const Outcome each :
       {Outcome::survived, Outcome::survived_smaller, Outcome::refused, Outcome::diverged,
        Outcome::wrong, Outcome::timeout, Outcome::crashed}) {
    if (text == to_string(each)) {
      outcome = each;
      return;
    }
  }
  throw json::other_error::create(502, "'" + text + "' is no outcome of a trial", nullptr);
}

json to_json(const TrialResult& result) {
  json object;
  write_fields(object, trial_fields, result);
  object["work"] = to_json(result.work);
  return object;
}

TrialResult trial_result_of(const json& object) {
  TrialResult result;
  read_fields(object, trial_fields, result);
  result.work = work_of(object.at("work"));
  return result;
}

}  // namespace harness
