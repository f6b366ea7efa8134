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

constexpr std::array differences{
    KnownDifference{"noise", "vertex_block_descent", Outcome::wrong, Outcome::wrong,
                    passes_end_first, "2000 passes a step, with which it survives"},
    KnownDifference{"drift/cloth", "augmented_vbd", Outcome::refused, Outcome::survived_smaller,
                    folds_wander, "direction_tolerance 30, with which it survives"},
    KnownDifference{"drift/cloth", "projective_dynamics", Outcome::refused,
                    Outcome::survived_smaller, folds_wander,
                    "direction_tolerance 3, with which it survives"},
    KnownDifference{"noise", "strips@bdf2", Outcome::wrong, Outcome::wrong, two_steps_gain,
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
