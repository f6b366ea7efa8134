#include "harness/stability/known_differences.h"

#include <algorithm>
#include <array>

namespace harness {
namespace {

constexpr const char* gains_first =
    "transverse waves beside the pin with omega h > 2 gain energy for some steps before one is "
    "refused and the controller halves the step: a few per cent of weight times size are in the "
    "motion by then";
constexpr const char* error_control =
    "a controller that looks at energy, or at omega h, and not at refusals alone";

constexpr const char* two_steps_gain =
    "a start 30 % beyond its edges is corrected in one step, and the two-step formula, no convex "
    "combination of the last states, adds energy to what that leaves; why fast projection's "
    "corrections do not let it show is not examined";
constexpr const char* one_step_first = "a step of backward Euler after a start beyond the limit";

constexpr const char* passes_end_first =
    "a hundred passes leave some of what noise of 30 % has stretched; the energy that springs keep "
    "is not counted, and becomes motion in the next steps";
constexpr const char* folds_wander =
    "the noise of a thousand steps folds the cloth; in one of these steps edges keep the limit, "
    "but "
    "vertices in folds under pressure go on moving from pass to pass";

constexpr const char* unfinished =
    "passes or iterations end before forces are those of the end of the step; backward Euler damps "
    "what that leaves, a two-step formula carries it on";
constexpr const char* finish = "not tried: more passes, or a smaller direction_tolerance";
constexpr const char* middle_turns =
    "the matrix has J of the middle of the step on both sides where Newton's has J(x_j) on one: it "
    "does not converge where edges turn much in a step, or are straight and at full length";
constexpr const char* smaller_turns = "not tried: the unsymmetric matrix";
constexpr const char* bounces =
    "edges that come to their limit keep 0.8 of their rate (spectral_radius)";
constexpr auto wrong = Outcome::wrong, refused = Outcome::refused,
               in_smaller = Outcome::survived_smaller;

constexpr std::array differences{
    KnownDifference{"swing/chain", "jacobi@midpoint", wrong, wrong, bounces,
                    "not tried: spectral_radius 0"},
    KnownDifference{"taut_row/0.01", "gauss_seidel_colored@midpoint", refused, refused,
                    "middles of edges of a straight row hardly turn: as many passes as in Q4",
                    "not tried: more passes than 1e5"},
    KnownDifference{"taut_row/0.01", "fast_projection@midpoint", refused, wrong, middle_turns,
                    smaller_turns},
    KnownDifference{"taut_row/0.001", "fast_projection@midpoint", refused, in_smaller, middle_turns,
                    smaller_turns},
    KnownDifference{"jump", "fast_projection@midpoint", refused, in_smaller, middle_turns,
                    smaller_turns},
    KnownDifference{"coincident", "pbd_substeps@bdf2", wrong, wrong,
                    "an edge without length has no direction until rounding gives it one; one pass "
                    "brings it to its length in that step, and BDF2 takes that for a velocity",
                    "not tried: a first step of backward Euler"},
    KnownDifference{"coincident", "pbd_substeps@midpoint", wrong, wrong, bounces,
                    "not tried: spectral_radius 0"},
    KnownDifference{"noise", "pbd_substeps@midpoint", wrong, wrong, bounces,
                    "not tried: spectral_radius 0"},
    KnownDifference{
        "chain/10000", "pbd_substeps@midpoint", Outcome::survived, Outcome::survived,
        "the chain stretches, but stays below what counts as diverged; why is not examined",
        "none is needed"},
    KnownDifference{"noise", "vertex_block_descent@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"swing/chain", "vertex_block_descent@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"swing/cloth", "vertex_block_descent@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"Q3/1e-10", "augmented_vbd@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"folded", "augmented_vbd@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"crack", "augmented_vbd@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"jump", "augmented_vbd@bdf2", refused, in_smaller, unfinished, finish},
    KnownDifference{"drift/cloth", "augmented_vbd@bdf2", refused, in_smaller, unfinished, finish},
    KnownDifference{"swing/cloth", "augmented_vbd@bdf2", refused, in_smaller, unfinished, finish},
    KnownDifference{"coincident", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"folded", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"plumb", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"upright", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"crack", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"hit", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"noise", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"drift/cloth", "admm@bdf2", refused, in_smaller, unfinished, finish},
    KnownDifference{"swing/chain", "admm@bdf2", wrong, wrong, unfinished, finish},
    KnownDifference{"noise", "vertex_block_descent", Outcome::wrong, Outcome::wrong,
                    passes_end_first, "2000 passes a step, with which it survives"},
    KnownDifference{"drift/cloth", "augmented_vbd", Outcome::refused, Outcome::survived_smaller,
                    folds_wander, "direction_tolerance 30, with which it survives"},
    KnownDifference{"drift/cloth", "admm", Outcome::refused, Outcome::survived_smaller,
                    folds_wander, "direction_tolerance 3, with which it survives"},
    KnownDifference{"noise", "yarn_projection@bdf2", Outcome::wrong, Outcome::wrong, two_steps_gain,
                    one_step_first},
    KnownDifference{"noise", "fast_projection_adaptive@bdf2", Outcome::wrong, Outcome::wrong,
                    two_steps_gain, one_step_first},
    KnownDifference{
        "drift/cloth", "icd", Outcome::refused, Outcome::survived_smaller,
        "the noise of a thousand steps folds the cloth; one of these steps takes Newton "
        "more than its 50 iterations, from the last multipliers and from zero",
        "damped projections as in fast projection where Newton makes no progress"},
    KnownDifference{"swing/chain", "shake", Outcome::refused, Outcome::wrong, gains_first,
                    error_control},
    KnownDifference{"swing/chain", "rattle", Outcome::refused, Outcome::wrong, gains_first,
                    error_control},
    KnownDifference{"swing/cloth", "shake", Outcome::refused, Outcome::wrong, gains_first,
                    error_control},
    KnownDifference{"swing/cloth", "rattle", Outcome::refused, Outcome::wrong, gains_first,
                    error_control},
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
  const auto place = std::find_if(differences.begin(), differences.end(), [&](const auto& known) {
    return hard_case == known.hard_case && solver == known.solver && result.fixed == known.fixed &&
           (result.outcome == known.outcome ||
            (harmless(result.outcome) && harmless(known.outcome)));
  });
  return place == differences.end() ? nullptr : &*place;
}

}  // namespace harness
