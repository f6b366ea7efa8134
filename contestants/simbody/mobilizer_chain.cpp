#include "contestants/simbody/mobilizer_chain.h"

#include <Simbody.h>

#include <cmath>

namespace engines {
namespace {

constexpr int most_internal_steps = 100'000;  // in one step of the harness

SimTK::Vec3 to_simbody(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d from_simbody(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::Rotation to_simbody(const Eigen::Matrix3d& axes) {
  SimTK::Mat33 rows;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) rows(r, c) = axes(r, c);
  }
  return SimTK::Rotation(rows);
}

std::unique_ptr<SimTK::Integrator> integrator_named(std::string_view name,
                                                    const SimTK::System& system) {
  if (name == "verlet") return std::make_unique<SimTK::VerletIntegrator>(system);
  if (name == "fehlberg") return std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system);
  return std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
}

}  // namespace

struct MobilizerChain::Parts {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  std::vector<SimTK::MobilizedBody> bodies;
  std::vector<SimTK::Vec3> ends;  // of links, in their bodies
  bool pins = false;
  SimTK::State start;
  std::unique_ptr<SimTK::Integrator> integrator;

  // Line orientations need the link along z; pins turn about z.
  void add_link(double length, double mass) {
    const SimTK::Vec3 end = pins ? SimTK::Vec3(length, 0, 0) : SimTK::Vec3(0, 0, length);
    const SimTK::Body::Rigid body(SimTK::MassProperties(mass, end, SimTK::Inertia(end, mass)));
    SimTK::MobilizedBody parent = bodies.empty() ? matter.updGround() : bodies.back();
    const SimTK::Vec3 joint = bodies.empty() ? SimTK::Vec3(0) : ends.back();
    if (pins) {
      bodies.push_back(SimTK::MobilizedBody::Pin(parent, joint, body, SimTK::Vec3(0)));
    } else {
      bodies.push_back(SimTK::MobilizedBody::LineOrientation(parent, joint, body, SimTK::Vec3(0)));
    }
    ends.push_back(end);
  }

  // against: the axes in those of the previous link; own_rate: against that link, in own axes.
  void set(std::size_t link, const Eigen::Matrix3d& against, const Eigen::Vector3d& own_rate) {
    SimTK::MobilizedBody& body = bodies[link];
    if (pins) {
      body.setOneQ(start, 0, std::atan2(against(1, 0), against(0, 0)));
      body.setOneU(start, 0, own_rate.z());
    } else {
      body.setQToFitRotation(start, to_simbody(against));
      body.setOneU(start, 0, own_rate.x());
      body.setOneU(start, 1, own_rate.y());
    }
  }
};

MobilizerChain::MobilizerChain(const Links& links, const Eigen::Vector3d& gravity, bool pins,
                               std::string_view integrator, double accuracy)
    : parts_(std::make_unique<Parts>()) {
  parts_->pins = pins;
  const SimTK::Force::UniformGravity weight(parts_->forces, parts_->matter, to_simbody(gravity));
  parts_->matter.setShowDefaultGeometry(false);
  for (int i = 0; i < links.count(); ++i) parts_->add_link(links.length[i], links.mass[i]);
  parts_->start = parts_->system.realizeTopology();
  parts_->system.realizeModel(parts_->start);
  parts_->integrator = integrator_named(integrator, parts_->system);
  parts_->integrator->setAccuracy(accuracy);
  parts_->integrator->setAllowInterpolation(false);
  parts_->integrator->setInternalStepLimit(most_internal_steps);
}

MobilizerChain::~MobilizerChain() = default;

void MobilizerChain::set(const LinkPoses& poses) {
  Eigen::Matrix3d before = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Eigen::Matrix3d axes = poses[i].axes;
    if (!parts_->pins) axes << poses[i].axes.col(1), poses[i].axes.col(2), poses[i].axes.col(0);
    parts_->set(i, before.transpose() * axes, axes.transpose() * poses[i].rate);
    before = axes;
  }
  parts_->start.setTime(0);
  parts_->integrator->initialize(parts_->start);
}

bool MobilizerChain::step(double h) {
  SimTK::Integrator& integrator = *parts_->integrator;
  const double end = integrator.getTime() + h;
  if (!(end > integrator.getTime())) return false;
  if (integrator.stepTo(end) == SimTK::Integrator::StartOfContinuousInterval)
    return integrator.stepTo(end) == SimTK::Integrator::ReachedReportTime;
  return integrator.getTime() == end;
}

int MobilizerChain::internal_steps() const { return parts_->integrator->getNumStepsAttempted(); }

MobilizerChain::Point MobilizerChain::end_of(int link) const {
  const SimTK::State& state = parts_->integrator->getState();
  parts_->system.realize(state, SimTK::Stage::Velocity);
  SimTK::Vec3 place, velocity;
  parts_->bodies[link].findStationLocationAndVelocityInGround(state, parts_->ends[link], place,
                                                              velocity);
  return {from_simbody(place), from_simbody(velocity)};
}

std::string simbody_version() {
  int major = 0, minor = 0, build = 0;
  SimTK_version_simbody(&major, &minor, &build);
  return std::to_string(major) + "." + std::to_string(minor) +
         (build ? "." + std::to_string(build) : "");
}

}  // namespace engines
