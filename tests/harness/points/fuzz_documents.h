// Whatever a user's file holds: a suite, a result, or UsageError with one line; nothing else gets
// out.
#pragma once

#include <sstream>
#include <string>

#include "harness/claims/claims.h"
#include "harness/points/result_file.h"
#include "harness/points/suite.h"
#include "harness/run/sweep.h"
#include "harness/tables/tables.h"
#include "support/refusal.h"

namespace harness::testing {

inline std::string read_as_suite(const std::string& text) {
  return refusal_of([&text] {
    const Suite suite = parse_suite(text, "fuzz");
    (void)to_json(suite).dump();
    std::size_t points = 0;  // planning is cheap, unless the suite asks for billions of points
    for (const SweepSpec& s : suite.sweeps)
      points += s.limits.size() * s.resolutions.size() * s.contestants.size();
    if (points < 10000) (void)plan(suite, {});
  });
}

inline std::string read_as_result(const std::string& text) {
  return refusal_of([&text] {
    const nlohmann::json result = parse_result(text, "fuzz");
    (void)judge_claims({result});
    std::ostringstream page;
    print_results_page(page, {{"fuzz", result}});
  });
}

}  // namespace harness::testing
