#include "harness/run/screening.h"

#include <cmath>
#include <stdexcept>

#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/run/calibration.h"

namespace harness {
namespace {

using inextensible::State;
using inextensible::StrainControl;

// Times each step, and looks at its strain off the clock.
struct FirstSteps : Observer {
  const inextensible::Stepper& stepper;
  double strain = 0, first = 0, later = 0;  // s: of the first step and of the later ones
  int steps = 0;
  Clock::time_point begin;

  explicit FirstSteps(const inextensible::Stepper& s) : stepper(s) {}
  int before(const State& /*state*/, const DriveState& /*driven*/) {
    begin = Clock::now();
    return 1;
  }
  void all(const State& /*state*/, const DriveState& driven) {
    if (driven.taken == 0) return;
    (steps++ == 0 ? first : later) += since(begin);
  }
  bool after(const State& /*state*/, const DriveState& /*driven*/) {
    raise(strain, strain_range(stepper.problem(), stepper.filtered_positions()).most);
    return true;
  }
  // The first step sets up what the others use.
  double seconds_of_a_step() const { return steps == 1 ? first : later / (steps - 1); }
};

void screen(PointResult& point, double look, std::optional<double> guess) {
  const PointSpec& spec = point.spec;
  const Scene scene = find_scene(spec.scene)->build(spec.scene_parameters);
  const auto& backend = *inextensible::find_backend(spec.solver);
  inextensible::Settings settings = spec.settings;
  const bool springs =
      backend.strain_control == StrainControl::stiffness && !settings.contains("stiffness");
  if (springs) settings["stiffness"] = guess.value_or(first_stiffness(scene, spec.strain_limit));
  State state = start_of(scene, backend, spec.step);
  const auto stepper = inextensible::make_stepper(spec.solver, scene.problem,
                                                  {spec.strain_limit, spec.seed, settings, &state});
  FirstSteps seen(*stepper);
  const DriveState driven =
      drive(*stepper, state, {spec.step, std::lround(std::ceil(scene.duration / spec.step))}, seen,
            {.timeout = look});
  if (seen.steps > 0) point.samples = {seen.seconds_of_a_step() / spec.step};
  if (driven.end == DriveState::End::refused) {
    point.status = PointStatus::not_converged;
    point.detail = driven.result.detail;
  } else if (!springs && backend.strain_control != StrainControl::none &&
             !(seen.strain <= spec.strain_limit * (1 + 1e-9))) {
    point.status = PointStatus::strain_missed;
    point.detail = "strain " + told_apart(seen.strain, spec.strain_limit);
  } else {
    point.status = PointStatus::ok;
  }
}

}  // namespace

PointResult screen_point(const PointSpec& spec, const RunLimits& limits,
                         std::optional<double> guess) {
  PointResult point;
  point.spec = spec;
  try {
    screen(point, limits.hopeless, guess);
  } catch (const std::bad_alloc&) {
    point.status = PointStatus::out_of_memory;
    point.detail = "an allocation failed";
  } catch (const std::invalid_argument& error) {  // refused at the door
    point.status = PointStatus::unsupported;
    point.detail = error.what();
  }
  return point;
}

}  // namespace harness
