// `bench check`: what every solver must satisfy, checked from outside, with advice to its author.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace harness {

struct Finding {
  enum class Grade { pass, fail, not_applicable };
  Grade grade = Grade::pass;
  std::string check;     // "pins"
  std::string measured;  // the number, and what is allowed; not_applicable: why
  std::string advice;    // of a failure: what it means and where to look
};

struct ConformanceOptions {
  std::uint64_t seed = 1;
  bool hard_cases = true;                                       // the longest part, up to minutes
  std::function<void(const Finding&)> finding = [](auto&&) {};  // as soon as it is known
  std::function<bool()> interrupted = nullptr;                  // asked several times a second
};

// Runs each check in a process of its own. `solver` must be registered. Throws Interrupted.
std::vector<Finding> examine(const std::string& solver, const ConformanceOptions& options);

}  // namespace harness
