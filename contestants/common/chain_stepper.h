// Base of engines in joint coordinates: links in place of vertices, with one angle each as long as
// the chain stays in the plane of x and y.
#pragma once

#include "contestants/common/engine.h"
#include "contestants/common/links.h"

namespace engines {

class ChainStepper : public EngineStepper {
 protected:
  ChainStepper(std::shared_ptr<const inextensible::Problem> shared,
               const inextensible::BackendOptions& options)
      : EngineStepper(std::move(shared)),
        links_(problem()),
        poses_(links_.count()),
        flat_(options.start && planar(links_, problem(), *options.start)) {}

  // Sets the poses of a state. Once it leaves the plane, the engine's chain is built for space and
  // stays so, or counters would not repeat.
  StepResult find(const State& state) {
    if (flat_ && !planar(links_, problem(), state)) {
      flat_ = false;
      build();
    }
    if (!find_poses(links_, state, flat_, poses_))
      return {inextensible::Status::not_finite, 0, -1, 0, "a link has no direction"};
    return {};
  }

  Links links_;
  LinkPoses poses_;
  bool flat_;

 private:
  void build() override = 0;  // the engine's chain, flat or not
};

}  // namespace engines
