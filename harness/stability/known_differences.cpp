#include <algorithm>

#include "harness/stability/hard_case.h"

namespace harness {
namespace {

using Cause = KnownDifference::Cause;

constexpr Cause gains_first{
    "transverse waves beside the pin with omega h > 2 gain energy for some steps before one is "
    "refused and the controller halves the step: a few per cent of weight times size are in the "
    "motion by then",
    "a controller that looks at energy, or at omega h, and not at refusals alone"};
constexpr Cause two_steps_gain{
    "a start 30 % beyond its edges is corrected in one step, and the two-step formula, no convex "
    "combination of the last states, adds energy to what that leaves; why fast projection's "
    "corrections do not let it show is not examined",
    "a step of backward Euler after a start beyond the limit"};
constexpr Cause passes_end_first{
    "a hundred passes leave some of what noise of 30 % has stretched; the energy that springs keep "
    "is not counted, and becomes motion in the next steps",
    "2000 passes a step, with which it survives"};
constexpr const char* folds =
    "the noise of a thousand steps folds the cloth; in one of these steps edges keep the limit, "
    "but vertices in folds under pressure go on moving from pass to pass";
constexpr Cause folds_of_vbd{folds, "direction_tolerance 30, with which it survives"};
constexpr Cause folds_of_admm{folds, "direction_tolerance 3, with which it survives"};
constexpr Cause newton_in_folds{
    "the noise of a thousand steps folds the cloth; one of these steps takes Newton more than its "
    "50 iterations, from the last multipliers and from zero",
    "damped projections as in fast projection where Newton makes no progress"};
constexpr Cause unfinished{
    "passes or iterations end before forces are those of the end of the step; backward Euler damps "
    "what that leaves, a two-step formula carries it on",
    "not tried: more passes, or a in_smaller direction_tolerance"};
constexpr Cause middle_turns{
    "the matrix has J of the middle of the step on both sides where Newton's has J(x_j) on one: it "
    "does not converge where edges turn much in a step, or are straight and at full length",
    "not tried: the unsymmetric matrix"};
constexpr Cause middle_stays{
    "middles of edges of a straight row hardly turn: as many passes as in Q4",
    "not tried: more passes than 1e5"};
constexpr Cause bounces{"edges that come to their limit keep 0.8 of their rate (spectral_radius)",
                        "not tried: spectral_radius 0"};
constexpr Cause no_direction{
    "an edge without length has no direction until rounding gives it one; one pass brings it to "
    "its length in that step, and BDF2 takes that for a velocity",
    "not tried: a first step of backward Euler"};
constexpr Cause stretches{
    "the chain stretches, but stays below what counts as diverged; why is not examined",
    "none is needed"};
constexpr auto wrong = Outcome::wrong, refused = Outcome::refused, survived = Outcome::survived,
               in_smaller = Outcome::survived_smaller;

const KnownDifference differences[] = {
    {"jacobi@midpoint", wrong, wrong, bounces, {"swing/chain"}},
    {"pbd_substeps@midpoint", wrong, wrong, bounces, {"coincident", "noise"}},
    {"pbd_substeps@midpoint", survived, survived, stretches, {"chain/10000"}},
    {"pbd_substeps@bdf2", wrong, wrong, no_direction, {"coincident"}},
    {"gauss_seidel_colored@midpoint", refused, refused, middle_stays, {"taut_row/0.01"}},
    {"fast_projection@midpoint", refused, wrong, middle_turns, {"taut_row/0.01"}},
    {"fast_projection@midpoint", refused, in_smaller, middle_turns, {"taut_row/0.001", "jump"}},
    {"vertex_block_descent", wrong, wrong, passes_end_first, {"noise"}},
    {"vertex_block_descent@bdf2",
     wrong,
     wrong,
     unfinished,
     {"noise", "swing/chain", "swing/cloth"}},
    {"augmented_vbd", refused, in_smaller, folds_of_vbd, {"drift/cloth"}},
    {"augmented_vbd@bdf2", wrong, wrong, unfinished, {"Q3/1e-10", "folded", "crack"}},
    {"augmented_vbd@bdf2", refused, in_smaller, unfinished, {"jump", "drift/cloth", "swing/cloth"}},
    {"admm", refused, in_smaller, folds_of_admm, {"drift/cloth"}},
    {"admm@bdf2", wrong, wrong, unfinished, {"coincident", "folded", "plumb", "upright"}},
    {"admm@bdf2", wrong, wrong, unfinished, {"crack", "hit", "noise", "swing/chain"}},
    {"admm@bdf2", refused, in_smaller, unfinished, {"drift/cloth"}},
    {"yarn_projection@bdf2", wrong, wrong, two_steps_gain, {"noise"}},
    {"fast_projection_adaptive@bdf2", wrong, wrong, two_steps_gain, {"noise"}},
    {"icd", refused, in_smaller, newton_in_folds, {"drift/cloth"}},
    {"shake", refused, wrong, gains_first, {"swing/chain", "swing/cloth"}},
    {"rattle", refused, wrong, gains_first, {"swing/chain", "swing/cloth"}},
};

// With smaller steps, after a refusal; which of them it is may be up to the clock.
bool harmless(Outcome outcome) {
  return outcome == Outcome::refused || outcome == Outcome::survived_smaller ||
         outcome == Outcome::timeout;
}

}  // namespace

std::span<const KnownDifference> known_differences() { return differences; }

const KnownDifference* known_difference(const std::string& hard_case, const std::string& solver,
                                        const TrialResult& result) {
  const auto known = std::ranges::find_if(differences, [&](const KnownDifference& one) {
    return solver == one.solver && result.fixed == one.fixed &&
           (result.outcome == one.outcome || (harmless(result.outcome) && harmless(one.outcome))) &&
           std::ranges::count(one.hard_cases, hard_case) > 0;
  });
  return known == std::end(differences) ? nullptr : known;
}

}  // namespace harness
