// A chain of mobilizers in Simbody: joint coordinates, so that links keep their length to rounding,
// and accelerations in O(n). A link is a body whose mass is a point at its end. It turns on a pin
// as long as the chain stays in the plane of x and y, on a line orientation otherwise, which has
// quaternions and no spin about the link. The integrator chooses its own steps to the
// accuracy asked for; a step of the harness is what it must end on.
// Loops: over links, five times an internal step.
//
// Departure: none from Simbody. Where a step begins with what the last one ended with, bit for bit,
// Simbody continues from its own state; otherwise it is set again, which takes another first step.
#include <Simbody.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "contestants/common/links.h"

namespace {

using engines::Links;
using SimTK::MobilizedBody, SimTK::Vec3;

constexpr int most_internal_steps = 100'000;  // in one step of the harness

enum Setting { accuracy, integrator };
const char* const integrators[] = {"merson", "fehlberg", "verlet", nullptr};

struct Chain {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::vector<MobilizedBody> bodies;
  std::vector<Vec3> ends;  // of links, in their bodies
  bool pins;
  SimTK::State start;
  std::unique_ptr<SimTK::Integrator> stepper;

  // Line orientations need the link along z; pins turn about z.
  Chain(const Links& links, const double* settings) : pins(links.flat) {
    const Eigen::Vector3d& g = links.gravity;
    const SimTK::Force::UniformGravity weight(forces, matter, Vec3(g.x(), g.y(), g.z()));
    matter.setShowDefaultGeometry(false);
    for (int i = 0; i < links.count(); ++i) {
      const Vec3 end = pins ? Vec3(links.length[i], 0, 0) : Vec3(0, 0, links.length[i]);
      const SimTK::Body::Rigid body(
          SimTK::MassProperties(links.mass[i], end, SimTK::Inertia(end, links.mass[i])));
      MobilizedBody parent = i == 0 ? matter.updGround() : bodies.back();
      const Vec3 joint = i == 0 ? Vec3(0) : ends.back();
      if (pins)
        bodies.push_back(MobilizedBody::Pin(parent, joint, body, Vec3(0)));
      else
        bodies.push_back(MobilizedBody::LineOrientation(parent, joint, body, Vec3(0)));
      ends.push_back(end);
    }
    start = system.realizeTopology();
    system.realizeModel(start);
    if (settings[integrator] == 0)
      stepper = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
    else if (settings[integrator] == 1)
      stepper = std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system);
    else
      stepper = std::make_unique<SimTK::VerletIntegrator>(system);
    stepper->setAccuracy(settings[accuracy]);
    stepper->setAllowInterpolation(false);
    stepper->setInternalStepLimit(most_internal_steps);
  }

  void set(const std::vector<engines::LinkPose>& poses) {
    Eigen::Matrix3d before = Eigen::Matrix3d::Identity();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Eigen::Matrix3d axes = poses[i].axes;
      if (!pins) axes << poses[i].axes.col(1), poses[i].axes.col(2), poses[i].axes.col(0);
      const Eigen::Matrix3d against = before.transpose() * axes;  // axes in the previous link's
      const Eigen::Vector3d rate = axes.transpose() * poses[i].rate;
      if (pins) {
        bodies[i].setOneQ(start, 0, std::atan2(against(1, 0), against(0, 0)));
        bodies[i].setOneU(start, 0, rate.z());
      } else {
        SimTK::Mat33 rows;
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) rows(r, c) = against(r, c);
        }
        bodies[i].setQToFitRotation(start, SimTK::Rotation(rows));
        bodies[i].setOneU(start, 0, rate.x());
        bodies[i].setOneU(start, 1, rate.y());
      }
      before = axes;
    }
    start.setTime(0);
    stepper->initialize(start);
  }

  // Whether it arrived.
  bool step(double h) {
    const double end = stepper->getTime() + h;
    if (!(end > stepper->getTime())) return false;
    if (stepper->stepTo(end) == SimTK::Integrator::StartOfContinuousInterval)
      return stepper->stepTo(end) == SimTK::Integrator::ReachedReportTime;
    return stepper->getTime() == end;
  }
};

class SimbodyChain : public engines::Engine {
 public:
  SimbodyChain(const InextensibleScene& scene, const double* settings)
      : vertices(scene.vertices), links_(scene), settings_{settings[0], settings[1]} {
    build();
  }

  void build() {
    chain_ = std::make_unique<Chain>(links_, settings_);
    ours_.clear();
  }

  int put_in(InextensibleStep& step) {
    const std::size_t size = 3 * static_cast<std::size_t>(vertices);
    start_x_.assign(step.x, step.x + size);
    if (ours_.size() == 2 * size && std::equal(step.x, step.x + size, ours_.begin()) &&
        std::equal(step.v, step.v + size, ours_.begin() + static_cast<std::ptrdiff_t>(size)))
      return INEXTENSIBLE_OK;  // is there already
    ours_.clear();
    if (!links_.find_poses(step.x, step.v)) {
      step.reason = "a link has no direction";
      return INEXTENSIBLE_NOT_FINITE;
    }
    if (chain_->pins != links_.flat) build();
    chain_->set(links_.poses);
    internal_steps_ = 0;
    return INEXTENSIBLE_OK;
  }

  int step(InextensibleStep& step) {
    ours_.clear();
    const bool arrived = chain_->step(step.h);
    step.iterations = chain_->stepper->getNumStepsAttempted() - internal_steps_;
    internal_steps_ = chain_->stepper->getNumStepsAttempted();
    if (!arrived) step.reason = "Simbody took too many steps";
    return arrived ? INEXTENSIBLE_OK : INEXTENSIBLE_NOT_CONVERGED;
  }

  void take_out(InextensibleStep& step) {
    const SimTK::State& state = chain_->stepper->getState();
    chain_->system.realize(state, SimTK::Stage::Velocity);
    Vec3 place, velocity;
    for (int i = 0; i < links_.count(); ++i) {
      chain_->bodies[i].findStationLocationAndVelocityInGround(state, chain_->ends[i], place,
                                                               velocity);
      for (int c = 0; c < 3; ++c) {
        step.x[3 * links_.vertex[i] + c] = start_x_[3 * links_.pin + c] + place[c];
        step.v[3 * links_.vertex[i] + c] = velocity[c];
      }
    }
    const std::size_t size = 3 * static_cast<std::size_t>(vertices);
    ours_.assign(step.x, step.x + size);
    ours_.insert(ours_.end(), step.v, step.v + size);
    std::fill_n(ours_.begin() + static_cast<std::ptrdiff_t>(size) + 3 * links_.pin, 3, 0.0);
  }

  const int vertices;

 private:
  Links links_;
  const double settings_[2];
  std::unique_ptr<Chain> chain_;
  int internal_steps_ = 0;
  std::vector<double> start_x_, ours_;  // ours: x and v that the last step ended with
};

const InextensibleSetting settings[] = {
    {"accuracy", "of the internal steps, relative", 1e-3, 1e-12, 0.5, 1e-6, 0.5, 0, nullptr},
    {"integrator", "Runge, Kutta and Merson's, Fehlberg's, or Verlet's of order 2", 0, 0, 0, 0, 0,
     0, integrators}};

}  // namespace

const InextensiblePlugin* inextensible_plugin() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return engines::plugin_of<SimbodyChain>(
      "engine_simbody",
      "Simbody " + std::to_string(major) + "." + std::to_string(minor) +
          (build ? "." + std::to_string(build) : ""),
      "a chain of mobilizers (joint coordinates), Runge-Kutta-Merson", "mobilizers",
      "Sherman, Seth and Delp 2011", INEXTENSIBLE_WHOLE_STEP, INEXTENSIBLE_UNKNOWN, settings);
}
