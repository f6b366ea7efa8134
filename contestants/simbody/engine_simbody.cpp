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

#include "contestants/common/chain_stepper.h"
#include "contestants/simbody/mobilizer_chain.h"

namespace {

using engines::MobilizerChain;
using inextensible::Problem;
using inextensible::Status;

class SimbodyChain final : public engines::ChainStepper {
 public:
  static constexpr const char* name = "engine_simbody";

  SimbodyChain(std::shared_ptr<const Problem> shared, const inextensible::BackendOptions& options)
      : ChainStepper(std::move(shared), options),
        accuracy_(options.number("accuracy")),
        integrator_(options.word("integrator")) {
    build();
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
  void build() override {
    chain_ = std::make_unique<MobilizerChain>(links_, problem().gravity(), flat_, integrator_,
                                              accuracy_);
    ours_.time = -1;
  }

  StepResult put_in(const State& state, double /*h*/) override {
    if (ours_.time >= 0 && ours_.x == state.x && ours_.v == state.v) return {};  // is there already
    const StepResult found = find(state);
    if (!found) return found;
    chain_->set(poses_);
    internal_steps_ = 0;
    return {};
  }

  StepResult step(double h) override {
    ours_.time = -1;
    const bool arrived = chain_->step(h);
    const int taken = chain_->internal_steps() - internal_steps_;
    internal_steps_ += taken;
    if (!arrived) return {Status::not_converged, taken, -1, 0, "Simbody took too many steps"};
    return {Status::ok, taken};
  }

  void take_out(const State& start, Positions& x, Positions& v) override {
    for (int i = 0; i < links_.count(); ++i) {
      const MobilizerChain::Point end = chain_->end_of(i);
      x.col(links_.vertex[i]) = start.x.col(links_.pin) + end.place;
      v.col(links_.vertex[i]) = end.velocity;
    }
  }

  void accept(const Positions& x, const Positions& v) override { ours_ = {x, v, 0}; }

  double accuracy_;
  std::string integrator_;
  std::unique_ptr<MobilizerChain> chain_;
  int internal_steps_ = 0;
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
