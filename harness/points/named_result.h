#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

// A result, and what messages and tables call it.
struct NamedResult {
  std::string name;
  nlohmann::json document;
};

}  // namespace harness
