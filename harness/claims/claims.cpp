#include "harness/claims/claims.h"

#include <algorithm>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;

// configs/claims.json has their words and rules.
const std::map<std::string, claims::Judge*> judges{{"C1", claims::chain_time_over_strain},
                                                   {"C2", claims::chain_time_over_resolution},
                                                   {"C3", claims::chain_speed},
                                                   {"C4", claims::springs_stiffness},
                                                   {"C5", claims::drape_time_over_strain},
                                                   {"C6", claims::drape_time_over_resolution},
                                                   {"C7", claims::residual_order},
                                                   {"C8", claims::same_frame},
                                                   {"C9", claims::failure_configurations},
                                                   {"C10", claims::no_drift},
                                                   {"C11", claims::matrix_sizes},
                                                   {"C12", claims::patch_sag},
                                                   {"C13", claims::strain_after_collision},
                                                   {"C14", claims::degrees_of_freedom_left},
                                                   {"C15", claims::shake_small_steps},
                                                   {"C16", claims::garment_slip}};

const json& claim_texts() {
  static const json texts = [] {
    const std::string path = source_path("configs/claims.json");
    return parse_commented(read_file(path, "file of claims"), path);
  }();
  return texts;
}

std::vector<ClaimVerdict> judge_points(const claims::Points& points) {
  std::vector<ClaimVerdict> all;
  for (const json& claim : claim_texts()) {
    all.push_back({judges.at(claim.at("id"))(points), claim.at("id"), claim.at("where"),
                   claim.at("statement"), claim.at("rule")});
    if (all.back().verdict == claims::not_measured) all.back().points.clear();
  }
  return all;
}

// A verdict that another measurement of the same runs changes is no verdict.
void mark_flip(ClaimVerdict& claim, const ClaimVerdict& again) {
  if (claim.verdict == again.verdict) return;
  claim.measured = claim.verdict + " by the first measurement of each run, " + again.verdict +
                   " by the last; " + claim.measured;
  claim.verdict = claims::undecided;
}

}  // namespace

void check_timed(const json& result) {
  if (!is_timed(result))
    throw UsageError(
        "a result was made with --untimed, so its times are meaningless; leave it out");
}

std::vector<ClaimVerdict> judge_claims(const std::vector<json>& results) try {
  for (const json& result : results) check_timed(result);
  const claims::Points points(results);
  std::vector<ClaimVerdict> all = judge_points(points);
  if (points.repeated) {
    const std::vector<json> reversed(results.rbegin(), results.rend());
    const std::vector<ClaimVerdict> again = judge_points(claims::Points(reversed));
    for (std::size_t i = 0; i < all.size(); ++i) mark_flip(all[i], again[i]);
  }
  return all;
} catch (const json::exception& error) {
  throw UsageError(std::string("a result file is incomplete: ") + error.what());
}

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
  out << "Times are compared at the fastest step whose error is at most 2 %, beside it at any "
         "motion. A 95 % interval that holds a bound\nleaves a claim undecided. Of two parts (a) "
         "and (b), both: reproduced, one: changed, none: not reproduced.\n\n";
  for (const auto& c : claims) {
    out << c.id << " (" << c.where << "): " << c.statement << "\n  " << c.verdict;
    if (!c.measured.empty()) out << ": " << c.measured;
    out << '\n';
    if (!c.rule.empty()) out << "  rule: " << c.rule << '\n';
    constexpr std::size_t shown = 4;
    for (std::size_t i = 0; i < std::min(shown, c.points.size()); ++i)
      out << (i == 0 ? "  points: " : "          ") << c.points[i] << '\n';
    if (c.points.size() > shown) out << "          and " << c.points.size() - shown << " more\n";
    out << '\n';
  }
}

void print_claims_markdown(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
  out << "| | claim | verdict | measured |\n|---|---|---|---|\n";
  for (const auto& c : claims) {
    out << "| " << c.id << ", " << c.where << " | " << c.statement << " | " << c.verdict << " | "
        << c.measured << " |\n";
  }
}

}  // namespace harness
