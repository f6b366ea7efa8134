
#include "harness/claims/claims.h"

#include <algorithm>

#include "harness/base/errors.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;

struct Claim {
  const char *id, *where, *statement;
  claims::Judge* judge;
  const char* rule;
};

constexpr Claim table[] = {
    {"C1", "Fig. 4a",
     "chain: as the strain limit falls, fast projection is asymptotically better than implicit "
     "springs",
     claims::chain_time_over_strain,
     "the time of implicit springs over that of fast projection, against the strain limit: "
     "reproduced if the log-log slope lies below 0, not reproduced if above. Beside it against the "
     "error at any limit (step sweeps: least time within it)"},
    {"C2", "Fig. 4b",
     "chain at 1 %: fast projection scales better with resolution than implicit springs",
     claims::chain_time_over_resolution,
     "the same against vertices: reproduced if the log-log slope lies above 0, not reproduced if "
     "below"},
    {"C3", "Sec. 5", "chain of 80 at 1 %: fast projection is 25 times faster", claims::chain_speed,
     "implicit springs' time over fast projection's at 1 % strain: reproduced if between 12.5 and "
     "50, changed if between 1 and 12.5 or above 50, not reproduced if below 1"},
    {"C4", "Sec. 5", "the stiffness that meets a small strain cannot be set beforehand",
     claims::springs_stiffness,
     "a stiffness set a priori would be EA = c x weight a strand / limit, with the geometric mean "
     "c of the scene and size where most calibrations met their limit at one step. Elsewhere in "
     "strain sweeps at that step, the strain is off its limit by the ratio of the c's: reproduced "
     "if somewhere by more than a factor of 2, not reproduced if nowhere; the law is good for 15 "
     "%"},
    {"C5", "Fig. 5a",
     "drape: SHAKE, ICD and fast projection scale alike and better than strain limiting; fast "
     "projection is fastest of them",
     claims::drape_time_over_strain,
     "the paper's six methods, at the largest size at which three limits are met by all that a "
     "slope needs: (a) as the limit falls, the time of Jacobi and of Gauss-Seidel grows over that "
     "of each of SHAKE, ICD and fast projection (log-log slope below 0); (b) fast projection takes "
     "less time than SHAKE and ICD at every limit that these reach (ratio above 1)"},
    {"C6", "Fig. 5b", "drape at 1 %: fast projection beats all others at every resolution",
     claims::drape_time_over_resolution,
     "against the others of the paper's six methods: reproduced if fast projection takes less time "
     "than each at every size (ratio above 1), changed if at the largest but not at all, not "
     "reproduced if not at the largest"},
    {"C7", "Fig. 3",
     "the first iteration removes the first-order part of F; later ones change it at higher "
     "order, often downwards; F is O(h^2)",
     claims::residual_order,
     "sampled steps of step sweeps that took two iterations or more, at the tightest limit with "
     "four steps that have ten of them each, in every scene that has them: (a) the residual after "
     "the first iteration is of second order: its log-log slope over h lies above 1.5; (b) what "
     "later iterations change is of higher order: its slope is larger than the first's"},
    {"C8", "Fig. 6", "the same frame from fast projection and ICD looks alike", claims::same_frame,
     "fast projection and ICD side by side at one step and limit (stability sweep), the drape "
     "alone: (a) before the cloth touches the sphere no vertex is 1 % of the cloth's size or more "
     "apart; (b) afterwards potential energy, kinetic energy, corner height and shadow differ by "
     "less than 1 % beyond what two runs of the reference's ensemble may (three standard "
     "deviations of a difference; not so: by more than 2 %; between: open)"},
    {"C9", "Fig. 2", "SHAKE fails in Q1, Q2 and Q4 at any step; fast projection and ICD do not",
     claims::failure_configurations,
     "reproduced if SHAKE refuses exactly Q1, Q2 and Q4 at the fixed step and with smaller ones, "
     "and fast projection and ICD survive them, and Q3 at least with smaller steps; changed if "
     "SHAKE gets through some of them, or through with smaller steps; not reproduced otherwise"},
    {"C10", "Sec. 2, 6", "no drift: constraint error does not accumulate", claims::no_drift,
     "hard cases that last ten simulated seconds, with and without vertices displaced before "
     "every step; in all runs of fast projection's and ICD's families that survive, with smaller "
     "steps if need be, the largest strain of the last second is at most 1.5 times that of the "
     "first: reproduced; more than 3 times in one: not reproduced; between: undecided; changed if "
     "no error accumulates, but a run is refused or fails otherwise"},
    {"C11", "Sec. 4.3", "fast projection's matrix is smaller than ICD's, definite, and sparser",
     claims::matrix_sizes,
     "at each drape size that both ran, ICD with its own matrix factored (projected conjugate "
     "gradients factor fast projection's): reproduced if ICD's factor has more nonzeros; the "
     "matrices are 2 n and 5 n wide by construction"},
    {"C12", "Fig. 1",
     "a patch pinned at two corners sags visibly differently at 10 %, 1 % and less",
     claims::patch_sag,
     "the hung patch, each of the paper's methods at its best step, mean over the last of three "
     "seconds: how much lower the middle of its lower edge hangs at 10 % than at 1 %, and there "
     "than at 0.1 %; reproduced if both are at least 1 % of the side for every method that has "
     "all three, not reproduced if for none, else changed"},
    {"C13", "Sec. 6", "strain stays negligible after the obstacle has pushed vertices out, too",
     claims::strain_after_collision,
     "the drape in the paper's order, the collision filter last (contact 0): of every ranked "
     "contestant the best point of each limit and size. Its largest strain after that filter is "
     "at most 1.5 times the limit; reproduced if so of all, changed if of most, not reproduced if "
     "not of most, undecided if of half of them (strains repeat exactly, without noise)"},
    {"C14", "Sec. 3",
     "quads keep about n degrees of freedom; triangles with all edges constrained lock",
     claims::degrees_of_freedom_left,
     "degrees of freedom per vertex (3 less the rank of J over the vertices, SuiteSparseQR): "
     "reproduced if with quads within 25 % of 1 on the largest mesh, with triangles below a fifth "
     "of that; not reproduced otherwise"},
    {"C15", "Sec. 5", "SHAKE needs very small, cheap steps; ICD takes larger, expensive ones",
     claims::shake_small_steps,
     "the drape's strain and resolution sweeps, at every limit and size at which both SHAKE and "
     "ICD have a run whose error is at most 2 %: reproduced if at each of them SHAKE's fastest "
     "step is smaller than ICD's (all steps that the 95 % interval of their time cannot tell from "
     "the fastest counted in) and a step takes less time (interval of the ratio below 1); changed "
     "if at most of them, not reproduced if not at most of them, undecided if at half of them or "
     "if intervals leave it open. Beside it the same at any motion"},
    {"C16", "Fig. 7",
     "with little strain a tight garment does not slip past a narrowing of the body",
     claims::garment_slip,
     "the garment, each of the paper's methods at its best step, mean over the last third of the "
     "run: its rim is to stay above the body's hips at 1 %, and to be below them at 10 %; "
     "reproduced if so with every method that has both, not reproduced if with none, else changed"},
};

std::vector<ClaimVerdict> judge_points(const claims::Points& points) {
  std::vector<ClaimVerdict> all;
  for (const Claim& claim : table) {
    all.push_back({claim.judge(points), claim.id, claim.where, claim.statement, claim.rule});
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
