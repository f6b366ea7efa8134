// The table strain x error: who is fastest within a strain limit and an error, for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>

namespace harness {

// For each scene and size of a result document a line for each answer, levels of error with the
// same answer in one. At most 120 columns wide.
void print_planes(std::ostream& out, const nlohmann::json& document);

}  // namespace harness
