#include "harness/points/identity.h"

#include "harness/base/json_reader.h"

namespace harness {

using nlohmann::json;

json identity(const json& build_context, const json& suite, const json& selection) {
  const json& build = build_context.at("build");
  return {{"processor", build_context.at("cpu_model")},
          {"compiler", build.at("compiler")},
          {"compiler flags", build.at("flags")},
          {"program", build.value("binary", build.at("git").get<std::string>())},
          {"libraries", build_context.at("libraries")},
          {"suite", suite},
          {"selection", selection}};
}

std::string difference(const json& was, const json& is) {
  const json patch = json::diff(was, is);
  if (patch.empty()) return "";
  const json::json_pointer place(patch.at(0).at("path").get<std::string>());
  const auto text = [&place](const json& document) {
    return document.contains(place) ? value_text(document.at(place)) : std::string("not there");
  };
  std::string name = place.to_string().substr(1);
  return name + " is " + text(is) + ", was " + text(was);
}

}  // namespace harness
