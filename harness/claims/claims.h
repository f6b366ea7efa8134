// The claims C1 to C16 of Goldenthal et al. 2007, each decided from result files by a stated rule.
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace harness {

struct ClaimVerdict {
  std::string id, where, statement;
  std::string verdict;              // see verdicts.h
  std::string measured;             // one or two sentences with figures
  std::string rule;                 // how the verdict follows from them
  std::vector<std::string> points;  // ids behind it
};

// Throws UsageError for a result of --untimed, whose times say nothing.
void check_timed(const nlohmann::json& result);

// results: documents of schema inextensible-bench/1 and inextensible-stability/1; their points are
// taken together. Where several documents have a point, the first one's counts, and a verdict that
// the last one's would change is undecided. Throws UsageError for documents that lack what a claim
// looks at.
std::vector<ClaimVerdict> judge_claims(const std::vector<nlohmann::json>& results);

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims);
void print_claims_markdown(std::ostream& out, const std::vector<ClaimVerdict>& claims);

}  // namespace harness
