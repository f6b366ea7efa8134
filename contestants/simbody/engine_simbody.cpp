// A chain of mobilizers in Simbody: joint coordinates, so that links keep their length to rounding,
// and accelerations in O(n). A link is a body whose mass is a point at its end. It turns on a pin
// as long as the chain stays in the plane of x and y, on a line orientation otherwise, which has
// quaternions and no spin about the link. The integrator chooses its own steps to the
// accuracy asked for; a step of the harness is what it must end on.
// Loops: over links, five times an internal step.
//
// Departure: none from Simbody. Where a step begins with what the last one ended with, bit for bit,
// Simbody continues from its own state; otherwise it is set again, which takes another first step.
#include <string>

#include "contestants/common/engine.h"
#include "contestants/common/links.h"
#include "contestants/simbody/mobilizer_chain.h"

namespace {

using engines::LinkPoses;
using engines::Links;
using engines::MobilizerChain;
using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;
using inextensible::Status;
using inextensible::StepResult;
using inextensible::Stopwatch;

class SimbodyChain final : public inextensible::Stepper {
 public:
  static constexpr const char* name = "engine_simbody";

  SimbodyChain(std::shared_ptr<const Problem> shared, const inextensible::BackendOptions& options)
      : Stepper(std::move(shared)),
        accuracy_(options.number("accuracy")),
        integrator_(options.word("integrator")),
        links_(problem()),
        poses_(links_.count()),
        v_(3, problem().vertices()) {
    make(options.start && planar(links_, problem(), *options.start));
  }

  static std::vector<inextensible::SettingInfo> settings() {
    return {{"accuracy", 1e-3, "of the internal steps, relative", inextensible::Range{1e-12, 0.5},
             inextensible::SearchRange{1e-6, 0.5}},
            inextensible::word_setting(
                "integrator", MobilizerChain::integrators[0],
                "Runge, Kutta and Merson's, Fehlberg's, or Verlet's of order 2",
                {std::begin(MobilizerChain::integrators), std::end(MobilizerChain::integrators)})};
  }

 private:
  void make(bool pins) {
    chain_ = std::make_unique<MobilizerChain>(links_.length, links_.mass, problem().gravity(), pins,
                                              integrator_, accuracy_);
    ours_.time = -1;
  }

  // Whether Simbody is already where the step begins.
  bool goes_on(const State& state) const {
    return ours_.time >= 0 && ours_.x == state.x && ours_.v == state.v;
  }

  StepResult solve(const State& state, double h, Positions& x) override {
    try {
      return take(state, h, x);
    } catch (const std::exception&) {  // of Simbody, which says so of a step that fails
      ours_.time = -1;
      return {Status::not_converged, 0, -1, 0, "Simbody's integrator gave up"};
    }
  }

  StepResult take(const State& state, double h, Positions& x) {
    Stopwatch stopwatch(phases_wanted_);
    if (!goes_on(state)) {
      const bool in_plane = planar(links_, problem(), state);
      if (!in_plane && chain_->pins()) make(false);
      if (!find_poses(links_, state, chain_->pins(), poses_))
        return {Status::not_finite, 0, -1, 0, "a link has no direction"};
      chain_->set(poses_);
      internal_steps_ = 0;
    }
    ours_.time = -1;
    phases_.copy += stopwatch();
    const bool arrived = chain_->step(h);
    phases_.filter += stopwatch();
    const int taken = chain_->internal_steps() - internal_steps_;
    internal_steps_ += taken;
    if (!arrived) return {Status::not_converged, taken, -1, 0, "Simbody took too many steps"};
    for (int i = 0; i < links_.count(); ++i) {
      const MobilizerChain::Point end = chain_->end_of(i);
      x.col(links_.vertex[i]) = state.x.col(links_.pin) + end.place;
      v_.col(links_.vertex[i]) = end.velocity;
    }
    x.col(links_.pin) = state.x.col(links_.pin);
    v_.col(links_.pin).setZero();
    ours_ = {x, v_, 0};
    phases_.copy += stopwatch();
    return {Status::ok, taken};
  }

  StepResult end_velocities(const State& /*start*/, double /*h*/, const Positions& /*filtered*/,
                            const Positions& /*x*/, Positions& v) override {
    v = v_;
    return {};
  }

  double accuracy_;
  std::string integrator_;
  Links links_;
  LinkPoses poses_;
  std::unique_ptr<MobilizerChain> chain_;
  int internal_steps_ = 0;
  Positions v_;
  State ours_{{}, {}, -1};  // what the last step ended with; time -1: none
};

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  return engines::plugin_of<SimbodyChain>(
      "Simbody " + engines::simbody_version(),
      "a chain of mobilizers (joint coordinates), Runge-Kutta-Merson", "mobilizers",
      [](inextensible::Backend& row) {
        row.citation = "Sherman, Seth and Delp 2011";
        row.velocities = inextensible::Velocities::whole_step;
      });
}
