// What `bench choose` says of what it found.
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "harness/run/choose.h"

namespace harness {

struct ChoiceReport {
  const SweepSpec& sweep;
  Wish wish;
  const Trials& trials;
  double seconds;         // that it took
  std::string reference;  // the method that errors are measured against; empty: none
};

void print(std::ostream& out, const ChoiceReport& report);
nlohmann::json to_json(const ChoiceReport& report);

}  // namespace harness
