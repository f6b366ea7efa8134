// A chain of mobilizers in Simbody: joint coordinates, so that links keep their length to rounding,
// and accelerations in O(n). A link is a body whose mass is a point at its end. It turns on a pin
// as long as the chain stays in the plane of x and y, on a line orientation otherwise. Runge, Kutta
// and Merson's integrator chooses its own steps, by their accuracy, up to the end of bench's step.
// Loops: over links, five times an internal step.
//
// Departure: none from Simbody. Where a step begins with what the last one ended with, bit for bit,
// Simbody continues from its own state; otherwise it is set again, which takes another first step.
#include <Simbody.h>

#include <memory>

#include "contestants/common/links.h"

namespace {

using SimTK::MobilizedBody, SimTK::Vec3;

struct Chain {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::vector<MobilizedBody> bodies;
  SimTK::Rotation axes;  // of joints, in links: pins turn about z, line orientations want it along
  bool flat;
  SimTK::State start;
  SimTK::RungeKuttaMersonIntegrator stepper{system};

  Chain(const engines::Links& links, double accuracy) : flat(links.flat) {
    const SimTK::Force::UniformGravity weight(forces, matter, Vec3(links.gravity.data()));
    if (!flat) axes.setRotationFromAngleAboutY(SimTK::Pi / 2);
    for (int i = 0; i < links.count(); ++i) {
      const Vec3 end(links.length[i], 0, 0);
      const SimTK::Body::Rigid body(
          SimTK::MassProperties(links.mass[i], end, SimTK::Inertia(end, links.mass[i])));
      MobilizedBody parent = i == 0 ? matter.updGround() : bodies.back();
      const SimTK::Transform joint(axes, Vec3(i == 0 ? 0 : links.length[i - 1], 0, 0));
      if (flat) bodies.push_back(MobilizedBody::Pin(parent, joint, body, axes));
      if (!flat) bodies.push_back(MobilizedBody::LineOrientation(parent, joint, body, axes));
    }
    start = system.realizeTopology();
    system.realizeModel(start);
    stepper.setAccuracy(accuracy);
    stepper.setAllowInterpolation(false);
    stepper.setInternalStepLimit(100'000);  // in one step of bench
  }

  void set(const std::vector<engines::LinkPose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto& [q, rate] = poses[i];
      const SimTK::Rotation turn(SimTK::Quaternion(q.w(), q.x(), q.y(), q.z()));
      bodies[i].setQToFitRotation(start, ~axes * turn * axes);
      bodies[i].setUToFitAngularVelocity(start, ~axes * (turn * Vec3(rate.data())));
    }
    stepper.initialize(start);
  }
};

class SimbodyChain {
 public:
  SimbodyChain(const InextensibleScene& scene, const double* settings)
      : links_(scene), accuracy_(settings[0]), chain_(std::make_unique<Chain>(links_, accuracy_)) {}

  void put_in(InextensibleStep& step) {
    const auto x = engines::columns(step.x, links_.count() + 1);
    const auto v = engines::columns(step.v, links_.count() + 1);
    if (x_.size() == x.size() && x_ == x && v_ == v) return;  // is there already
    links_.find_poses(step);
    if (chain_->flat != links_.flat) chain_ = std::make_unique<Chain>(links_, accuracy_);
    chain_->set(links_.poses);
  }

  void step(InextensibleStep& step) {
    x_.resize(3, 0);  // the end is not known
    SimTK::Integrator& stepper = chain_->stepper;
    stepper.resetAllStatistics();
    const double end = stepper.getTime() + step.h;
    if (stepper.stepTo(end) == SimTK::Integrator::StartOfContinuousInterval) stepper.stepTo(end);
    step.iterations = stepper.getNumStepsAttempted();
    if (stepper.getTime() != end)
      throw engines::Refusal{INEXTENSIBLE_NOT_CONVERGED, "Simbody took too many steps"};
  }

  void take_out(InextensibleStep& step) {
    const SimTK::State& state = chain_->stepper.getState();
    chain_->system.realize(state, SimTK::Stage::Velocity);
    auto x = engines::columns(step.x, links_.count() + 1);
    auto v = engines::columns(step.v, links_.count() + 1);
    Vec3 place, velocity;
    for (int i = 0; i < links_.count(); ++i) {
      chain_->bodies[i].findStationLocationAndVelocityInGround(state, Vec3(links_.length[i], 0, 0),
                                                               place, velocity);
      x.col(links_.vertex[i]) = x.col(links_.pin) + Eigen::Vector3d(&place[0]);
      v.col(links_.vertex[i]) = Eigen::Vector3d(&velocity[0]);
    }
    x_ = x;
    v_ = v;
  }

 private:
  engines::Links links_;
  const double accuracy_;
  std::unique_ptr<Chain> chain_;
  Eigen::Matrix3Xd x_, v_;  // that the last step ended with
};

const InextensibleSetting settings[] = {
    {"accuracy", "of the internal steps, relative", 1e-3, 1e-12, 0.5, 1e-6, 0.5, 0, nullptr}};

}  // namespace

const InextensiblePlugin* inextensible_plugin() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return engines::plugin_of<SimbodyChain>(
      "engine_simbody", "Simbody " + std::to_string(major) + "." + std::to_string(minor),
      "a chain of mobilizers (joint coordinates), Runge-Kutta-Merson", "mobilizers",
      "Sherman, Seth and Delp 2011", INEXTENSIBLE_WHOLE_STEP, INEXTENSIBLE_UNKNOWN, settings);
}
