// Which program, machine and selection a result is of: what runs must share to be one run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

// What must agree for one run to go on where another stopped. build_context: machine_context();
// selection: options that choose points.
nlohmann::json identity(const nlohmann::json& build_context, const nlohmann::json& suite,
                        const nlohmann::json& selection);
// The first difference, in words: "compiler is 'GNU 13', was 'GNU 12'"; "" if there is none.
std::string difference(const nlohmann::json& was, const nlohmann::json& is);

}  // namespace harness
