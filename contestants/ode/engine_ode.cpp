// ODE, in double precision: a body of a point mass a vertex, and a joint that keeps the distance of
// two centres (DBall) an edge. A step is semi-implicit Euler's; multipliers make the velocity at
// its end one that takes the part `erp` of each elongation back, along directions at its start.
// They come from a factorization of the dense matrix (dWorldStep), or from passes of successive
// over-relaxation in random order, from 0 (dWorldQuickStep). Damping and disabling are off, there
// are not geometries.
// Shear, bending and drag, where a scene has them, are forces that the plug-in gives to bodies.
// Loops: over joints, `iterations` passes; "direct" m^3 / 6 for m edges.
//
// Departure: ODE's random numbers are one sequence for the program; each stepper has its own, which
// a refused step does not advance.
#include <ode/ode.h>

#include "contestants/common/engine.h"

namespace {

using inextensible::Problem;
using inextensible::Status;

// ODE's own ends the program.
[[noreturn]] void throw_error(int /*number*/, const char* /*message*/, va_list /*values*/) {
  throw std::runtime_error("ODE met numbers that it does not take");
}

struct Destroy {
  void operator()(dxWorld* world) const { dWorldDestroy(world); }
};
using World = std::unique_ptr<dxWorld, Destroy>;

class OdeBalls final : public engines::EngineStepper {
 public:
  static constexpr const char* name = "engine_ode";

  OdeBalls(std::shared_ptr<const Problem> shared, const inextensible::BackendOptions& options)
      : EngineStepper(std::move(shared)),
        options_(options),
        direct_(options.word("solver") == "direct"),
        random_(options.seed) {
    dAllocateODEDataForThread(dAllocateMaskAll);
    build();
  }

  // iterations and cfm are ODE's own by default.
  static std::vector<inextensible::SettingInfo> settings() {
    return {inextensible::word_setting("solver", "direct",
                                       "a factorization (dWorldStep) or passes (dWorldQuickStep)",
                                       {"direct", "passes"}),
            {"iterations", 20.0, "passes a step", inextensible::at_least_one,
             inextensible::SearchRange{1, 64}},
            {"relaxation", 1.3, "of passes", inextensible::relaxation_range,
             inextensible::SearchRange{0.5, 1.95, 2}},
            {"erp", 1.0, "part of an elongation that a step takes back", inextensible::fraction,
             inextensible::SearchRange{0.2, 1}},
            {"cfm", 1e-10, "compliance over the step, 1 / kg"}};
  }

 private:
  void build() override {
    world_.reset(dWorldCreate());
    const Eigen::Vector3d& g = problem().gravity();
    dWorldSetGravity(world_.get(), g.x(), g.y(), g.z());
    dWorldSetERP(world_.get(), options_.number("erp"));
    dWorldSetCFM(world_.get(), options_.number("cfm"));
    dWorldSetAutoDisableFlag(world_.get(), 0);
    dWorldSetDamping(world_.get(), 0, 0);
    dWorldSetQuickStepNumIterations(world_.get(), options_.count("iterations"));
    dWorldSetQuickStepW(world_.get(), options_.number("relaxation"));
    bodies_.assign(problem().vertices(), nullptr);
    for (int i = 0; i < problem().vertices(); ++i) {
      if (problem().inverse_mass()[i] == 0) continue;
      bodies_[i] = dBodyCreate(world_.get());
      dMass mass;  // ODE wants an inertia; nothing turns a body whose joints act on its centre
      const double radius = problem().constraints() > 0 ? problem().shortest_rest_length() : 1;
      dMassSetSphereTotal(&mass, problem().mass()[i], radius);
      dBodySetMass(bodies_[i], &mass);
      dBodySetGyroscopicMode(bodies_[i], 0);
    }
    joints_.clear();
    for (const auto& edge : problem().edges()) {
      joints_.push_back(dJointCreateDBall(world_.get(), nullptr));
      dJointAttach(joints_.back(), bodies_[edge.a], bodies_[edge.b]);
    }
  }

  // Anchors are kept relative to bodies. Those on pins are places of the world, which can be set
  // again; setting one measures the distance, which is put right after that.
  StepResult put_in(const State& state, double /*h*/) override {
    constexpr dMatrix3 unturned = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (int i = 0; i < problem().vertices(); ++i) {
      if (!bodies_[i]) continue;
      dBodySetPosition(bodies_[i], state.x(0, i), state.x(1, i), state.x(2, i));
      dBodySetLinearVel(bodies_[i], state.v(0, i), state.v(1, i), state.v(2, i));
      // Nothing turns it, but for a step that overflowed.
      dBodySetRotation(bodies_[i], unturned);
      dBodySetAngularVel(bodies_[i], 0, 0, 0);
      dBodySetForce(bodies_[i], 0, 0, 0);
      dBodySetTorque(bodies_[i], 0, 0, 0);
    }
    for (int k = 0; k < problem().constraints(); ++k) {
      const auto [a, b] = problem().edges()[k];
      dJointSetDBallAnchor1(joints_[k], state.x(0, a), state.x(1, a), state.x(2, a));
      dJointSetDBallAnchor2(joints_[k], state.x(0, b), state.x(1, b), state.x(2, b));
      dJointSetDBallDistance(joints_[k], problem().rest_length()[k]);
    }
    return {};
  }

  void give_force(int vertex, const Eigen::Vector3d& force) override {
    dBodyAddForce(bodies_[vertex], force.x(), force.y(), force.z());
  }

  StepResult step(double h) override {
    dRandSetSeed(random_);
    const bool taken =
        (direct_ ? dWorldStep(world_.get(), h) : dWorldQuickStep(world_.get(), h)) != 0;
    next_random_ = dRandGetSeed();
    const int passes = direct_ ? 1 : options_.count("iterations");
    if (direct_) {
      ++work_.assemblies;
      ++work_.factorizations;
      ++work_.back_solves;
    } else {
      work_.edge_projections += std::int64_t{passes} * problem().constraints();
    }
    if (!taken) return {Status::not_finite, 0, -1, 0, "ODE met numbers that it does not take"};
    return {Status::ok, passes};
  }

  void take_out(const State& /*start*/, Positions& x, Positions& v) override {
    for (int i = 0; i < problem().vertices(); ++i) {
      if (!bodies_[i]) continue;
      x.col(i) = Eigen::Map<const Eigen::Vector3d>(dBodyGetPosition(bodies_[i]));
      v.col(i) = Eigen::Map<const Eigen::Vector3d>(dBodyGetLinearVel(bodies_[i]));
    }
  }

  void accept(const Positions& /*x*/, const Positions& /*v*/) override { random_ = next_random_; }

  const inextensible::BackendOptions options_;  // `start` is that of the construction
  bool direct_;
  World world_;
  std::vector<dBodyID> bodies_;   // null: pinned, which is the world to ODE
  std::vector<dJointID> joints_;  // one an edge
  unsigned long random_, next_random_ = 0;
};

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  dInitODE2(0);
  dSetErrorHandler(throw_error);
  dSetDebugHandler(throw_error);
  dSetMessageHandler([](int, const char*, va_list) {});
  return engines::plugin_of<OdeBalls>(
      "ODE " ENGINE_VERSION,  // of the package; the library does not say
      "point bodies and joints of fixed distance, double", "joints",
      [](inextensible::Backend& row) {
        row.takes_shear = row.takes_bending = row.takes_drag = true;
        row.direction = inextensible::Direction::start;
        row.citation = "Smith 2001";
      });
}
