// One solver put through one hard case, and what the harness makes of it. No timing contest: the
// question is whether the solver survives, and whether it keeps its promises.
#pragma once

#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"

namespace harness {

enum class Outcome {
  survived,          // every step taken at the case's own step, all checks passed
  survived_smaller,  // as before, after a step controller had halved some steps
  refused,           // a clean refusal: at the door or in a step, state untouched
  timeout,
  diverged,  // positions or strains out of all proportion
  wrong,     // claimed success, and a check says otherwise
  crashed,   // took its process with it
};
inline constexpr const char* outcome_names[] = {
    "survived", "survived_smaller", "refused", "timeout", "diverged", "wrong", "crashed"};
constexpr const char* to_string(Outcome outcome) {
  return outcome_names[static_cast<std::size_t>(outcome)];
}

// What is put through the solver. A trial fails nothing by itself: `judge_...` say what must hold.
struct Trial {
  Scene scene;
  double step = 0.01;  // s
  int steps = 1;
  double strain_limit = 0.01;
  // N, of methods without a limit of their own: one that would keep it. Unknown: their default.
  double stiffness = unknown;
  std::map<std::string, Settings> settings = {};  // by solver
  // Changes the state before a step (moves a pin, adds noise). Energy is then not judged.
  std::function<void(State& state, int step)> disturb = nullptr;
  // Energy may exceed the start's by this fraction of the scale (weight times size, plus kinetic
  // energy at the start). Negative: not judged. A start that violates the limit sets energy free in
  // its first step; it is judged from there on.
  double energy_tolerance = 0.05;
  // m: how far vertices may move within the strain limit. A filter may undo all of it in one
  // step of h seconds, which makes kinetic energy of up to M (1.5 slack / h)^2 / 2 on top of the
  // above (1.5: the velocity of BDF2; 1 for one-step methods).
  double slack = 0;
  double momentum_tolerance = 1e-7;  // relative to what flows in a step
  // s of wall time, checked between steps. At its own step a trial ends by itself; the first limit
  // is for a busy machine. With smaller steps there is no other limit.
  double timeout = 60, timeout_smaller = 10;
};

enum class Promise { none, finite, strain, contact, pins, momentum, energy, counters };

// What each means: trial_fields.
struct TrialResult {
  Outcome fixed = Outcome::refused, outcome = Outcome::refused;
  std::string detail;
  double smallest_step = unknown, max_strain = unknown;
  double strain_first_second = unknown, strain_last_second = unknown;
  double energy_gain = unknown, momentum_defect = unknown, seconds = 0;
  WorkCounters work;               // of the last attempt
  Promise broken = Promise::none;  // of a wrong outcome; not in files
};

// Never throws: what goes wrong is the outcome. `build` makes the trial; a std::invalid_argument
// out of it (an impossible problem) is a refusal at the door.
TrialResult run_trial(const std::function<Trial()>& build, const std::string& solver,
                      std::uint64_t seed);

// run_trial() in a child; Outcome::crashed if it does not come back. Throws Interrupted.
TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed,
                               const std::function<bool()>& interrupted = nullptr);

// By its name; reading throws json::exception for any other text.
inline void to_json(json& name, Outcome outcome) { name = to_string(outcome); }
void from_json(const json& name, Outcome& outcome);

inline constexpr std::tuple trial_fields{
    field("outcome", &TrialResult::outcome, "", "with smaller steps where its own was refused"),
    field("at_fixed_step", &TrialResult::fixed, "", "at the trial's own step"),
    field("detail", &TrialResult::detail, "", "of a failure: step, reason, worst edge"),
    field("smallest_step", &TrialResult::smallest_step, "s", "accepted by the step controller",
          may_be_absent),
    field("max_strain", &TrialResult::max_strain, "",
          "after any accepted step, before the collision filter", may_be_absent),
    field("strain_first_second", &TrialResult::strain_first_second, "",
          "the same within the first simulated second, of trials of two or more", may_be_absent),
    field("strain_last_second", &TrialResult::strain_last_second, "",
          "the same within the last one", may_be_absent),
    field("energy_gain", &TrialResult::energy_gain, "scale",
          "largest E - E_0; negative: energy was lost throughout", may_be_absent),
    field("momentum_defect", &TrialResult::momentum_defect, "",
          "largest, relative, where nothing outside acts", may_be_absent),
    field("seconds", &TrialResult::seconds, "s", "wall, both attempts")};

json to_json(const TrialResult& result);
TrialResult trial_result_of(const json& object);

// The checks of one run, step after step: the harness's word against the solver's. Disturbs the
// steps of a drive, judges them, and raises the figures of a result. Stops where a step decides the
// outcome (`wrong` or `diverged`, with the reason in the result's detail).
class TrialJudge : public Observer {
 public:
  // All must outlive this.
  TrialJudge(const Trial& trial, const Backend& backend, const Stepper& stepper,
             TrialResult& result);

  int before(State& state, const DriveState& driven);
  bool after(const State& state, const DriveState& driven);
  // The same of a step of h seconds. filtered: positions before the collision filter.
  bool after(const Positions& filtered, const State& state, double h);
  // The outcome, after the last step.
  Outcome finish();

 private:
  // Each returns whether nothing is wrong.
  bool fail(Outcome outcome, const std::string& why, Promise broken = Promise::none);
  bool broke(Promise promise, const std::string& why) { return fail(Outcome::wrong, why, promise); }
  bool judge_counters(const DriveState& driven);
  bool judge_strain(const Positions& filtered, const State& state);
  bool judge_limit(const StrainRange& worst, const char* when);
  bool judge_contact(const State& state);
  bool judge_momentum(const State& state, double h);
  bool judge_energy(const State& state, double h);
  bool judge_gain(std::optional<double> gain, double release);

  const Trial& trial_;
  const Problem& problem_;
  const Stepper& stepper_;
  TrialResult& result_;
  Outcome outcome_ = Outcome::survived;
  bool limit_promised_;  // the solver claims to keep the trial's strain limit
  double mass_;
  bool free_;            // nothing outside but gravity acts
  bool judged_ = false;  // whether energy is
  bool energy_known_;    // what it is judged against; not before the first step of a start that
                         // violates the limit
  EnergyRecord energy_;
  double release_ = 0;  // of energy by slack in the last step
  State start_;
  WorkCounters work_;  // before the step
  // With contact inside only: where the obstacle is, and what is in it.
  std::optional<inextensible::Obstacle> obstacle_;
  std::vector<inextensible::ContactPlane> inside_;
};

}  // namespace harness
