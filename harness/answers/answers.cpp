// The known answers of configs/answers.json.
#include <algorithm>
#include <cmath>
#include <map>

#include "harness/answers/answer.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/scenes/chain_scenes.h"
#include "harness/scenes/fabrics.h"
#include "harness/scenes/meshes.h"

namespace harness {
namespace {

using nlohmann::json;

const std::map<std::string, Reading*> readings{{"distance_at_the_end", distance_at_the_end},
                                               {"turning_rate_kept", turning_rate_kept},
                                               {"swing_frequency", swing_frequency},
                                               {"swing_kept", swing_kept},
                                               {"catenary_tensions", catenary_tensions},
                                               {"folded_time", folded_time},
                                               {"folded_speed", folded_speed},
                                               {"net_angle_deviation", net_angle_deviation},
                                               {"drape_coefficient", drape_coefficient}};

const std::map<std::string, double (*)(const SceneParameters&)> formulas{
    {"hanging_frequency",
     [](const SceneParameters& at) {
       return hanging_frequency(static_cast<int>(at.at("n")) - 1, row_link(at), at.at("gravity"),
                                static_cast<int>(at.at("mode")));
     }},
    {"folded_fall_time",
     [](const SceneParameters& at) {
       return folded_fall_time(folded_part, at.at("length"), at.at("gravity"));
     }},
    {"folded_speed", [](const SceneParameters&) { return 1 / std::sqrt(1 - folded_part); }}};

KnownAnswer known_answer_of(const json& entry) {
  KnownAnswer answer{entry.at("name"),
                     entry.at("scene"),
                     entry.at("given"),
                     entry.at("quantity"),
                     entry.at("source"),
                     entry.at("strain_limit"),
                     {},
                     {},
                     readings.at(entry.at("reading")),
                     entry.value("needs_multipliers", false),
                     entry.value("continuum", false),
                     entry.value("until_read", false)};
  for (int i = 0; i < entry.at("steps").get<int>(); ++i)
    answer.steps.push_back(std::ldexp(entry.at("first_step").get<double>(), -i));
  json exact = entry.value("exact", json());
  if (entry.contains("fabric")) {
    const Fabric& cloth = fabric(entry.at("fabric").get<std::string>());
    answer.given["density"] = cloth.density;
    answer.given["bending"] = cloth.bending;
    exact = cloth.drape_coefficient;
  }
  answer.exact = [exact](const AnswerScene& at) {
    return exact.is_string() ? formulas.at(exact)(at.parameters) : exact.get<double>();
  };
  return answer;
}

}  // namespace

AnswerScene answer_scene(std::string_view name, const SceneParameters& given) {
  const auto type = find_scene(name);
  const SceneParameters parameters = complete_parameters(*type, given);
  return {type, parameters, type->build(parameters)};
}

std::span<const KnownAnswer> known_answers() {
  static const std::vector<KnownAnswer> table = [] {
    const std::string path = source_path("configs/answers.json");
    std::vector<KnownAnswer> all;
    for (const json& entry : parse_commented(read_file(path, "file of known answers"), path))
      all.push_back(known_answer_of(entry));
    return all;
  }();
  return table;
}

const KnownAnswer* find_answer(std::string_view name) {
  const auto found = std::ranges::find(known_answers(), name, &KnownAnswer::name);
  return found == known_answers().end() ? nullptr : &*found;
}

}  // namespace harness
