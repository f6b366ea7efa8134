#include "harness/claims/claims.h"

#include <algorithm>

#include "harness/base/errors.h"
#include "harness/claims/judging.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;

struct Row {
  const char* id;
  const char* where;
  const char* statement;
  void (*judge)(const claims::Points&, ClaimVerdict&);
};

constexpr Row rows[] = {
    {"C1", "Fig. 4a",
     "chain: as the strain limit falls, fast projection is asymptotically better than implicit "
     "springs",
     claims::chain_time_over_strain},
    {"C2", "Fig. 4b",
     "chain at 1 %: fast projection scales better with resolution than implicit springs",
     claims::chain_time_over_resolution},
    {"C3", "Sec. 5", "chain of 80 at 1 %: fast projection is 25 times faster", claims::chain_speed},
    {"C4", "Sec. 5", "the stiffness that meets a small strain cannot be set beforehand",
     claims::springs_stiffness},
    {"C5", "Fig. 5a",
     "drape: SHAKE, ICD and fast projection scale alike and better than strain limiting; fast "
     "projection is fastest of them",
     claims::drape_time_over_strain},
    {"C6", "Fig. 5b", "drape at 1 %: fast projection beats all others at every resolution",
     claims::drape_time_over_resolution},
    {"C7", "Fig. 3",
     "the first iteration removes the first-order part of F; later ones change it at higher order, "
     "often downwards; F is O(h^2)",
     claims::residual_order},
    {"C8", "Fig. 6", "the same frame from fast projection and ICD looks alike", claims::same_frame},
    {"C9", "Fig. 2", "SHAKE fails in Q1, Q2 and Q4 at any step; fast projection and ICD do not",
     claims::failure_configurations},
    {"C10", "Sec. 2, 6", "no drift: constraint error does not accumulate", claims::no_drift},
    {"C11", "Sec. 4.3", "fast projection's matrix is smaller than ICD's, definite, and sparser",
     claims::matrix_sizes},
    {"C12", "Fig. 1",
     "a patch pinned at two corners sags visibly differently at 10 %, 1 % and less",
     claims::patch_sag},
    {"C13", "Sec. 6", "strain stays negligible after the obstacle has pushed vertices out, too",
     claims::strain_after_collision},
    {"C14", "Sec. 3",
     "quads keep about n degrees of freedom; triangles with all edges constrained lock",
     claims::degrees_of_freedom_left},
    {"C15", "Sec. 5", "SHAKE needs very small, cheap steps; ICD takes larger, expensive ones",
     claims::shake_small_steps},
    {"C16", "Fig. 7",
     "with little strain a tight garment does not slip past a narrowing of the body",
     claims::garment_slip},
};

std::vector<ClaimVerdict> judge_points(const claims::Points& points) {
  std::vector<ClaimVerdict> all;
  for (const Row& row : rows) {
    ClaimVerdict claim{row.id, row.where, row.statement, claims::not_measured, "", "", {}};
    row.judge(points, claim);
    if (claim.verdict == claims::not_measured) claim.points.clear();
    all.push_back(std::move(claim));
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
  if (points.repeated()) {
    const std::vector<json> reversed(results.rbegin(), results.rend());
    const std::vector<ClaimVerdict> again = judge_points(claims::Points(reversed));
    for (std::size_t i = 0; i < all.size(); ++i) mark_flip(all[i], again[i]);
  }
  return all;
} catch (const json::exception& error) {
  throw UsageError(std::string("a result file is incomplete: ") + error.what());
}

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
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
