// Callbacks of a plan of small runs: hard cases, known answers.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace harness
