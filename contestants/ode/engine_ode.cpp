// ODE, in double precision: a body of a point mass a vertex, and a joint that keeps the distance of
// two centres (DBall) an edge. A step is semi-implicit Euler's; multipliers make the velocity at
// its end one that takes the part `erp` of each elongation back, along directions at its start.
// They come from a factorization of the dense matrix (dWorldStep), or from passes of successive
// over-relaxation in random order, from 0 (dWorldQuickStep). Damping and disabling are off, there
// are no geometries.
// Shear, bending and drag, where a scene has them, are forces that bench gives to bodies.
// Loops: over joints, `iterations` passes; "direct" m^3 / 6 for m edges.
//
// Departure: ODE's random numbers are one sequence for the program; each object has its own, which
// a refused step does not advance.
#include <ode/ode.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include "contestants/common/engine.h"

namespace {

enum Setting { solver, iterations, relaxation, erp, cfm };

// ODE's own ends the program.
[[noreturn]] void throw_error(int /*number*/, const char* /*message*/, va_list /*values*/) {
  throw std::runtime_error("ODE met numbers that it does not take");
}

struct Destroy {
  void operator()(dxWorld* world) const { dWorldDestroy(world); }
};

class OdeBalls : public engines::Engine {
 public:
  OdeBalls(const InextensibleScene& scene, const double* settings)
      : vertices(scene.vertices), scene_(scene), random_(scene.seed) {
    std::copy_n(settings, std::size(settings_), settings_);
    dAllocateODEDataForThread(dAllocateMaskAll);
    build();
  }

  void build() {
    world_.reset(dWorldCreate());
    dWorldSetGravity(world_.get(), scene_.gravity[0], scene_.gravity[1], scene_.gravity[2]);
    dWorldSetERP(world_.get(), settings_[erp]);
    dWorldSetCFM(world_.get(), settings_[cfm]);
    dWorldSetAutoDisableFlag(world_.get(), 0);
    dWorldSetDamping(world_.get(), 0, 0);
    dWorldSetQuickStepNumIterations(world_.get(), passes());
    dWorldSetQuickStepW(world_.get(), settings_[relaxation]);
    bodies_.assign(static_cast<std::size_t>(vertices), nullptr);
    const double radius =
        scene_.edges > 0 ? *std::min_element(scene_.rest_length, scene_.rest_length + scene_.edges)
                         : 1;
    for (int i = 0; i < vertices; ++i) {
      if (scene_.mass[i] == 0) continue;
      bodies_[i] = dBodyCreate(world_.get());
      dMass mass;  // ODE wants an inertia; nothing turns a body whose joints act on its centre
      dMassSetSphereTotal(&mass, scene_.mass[i], radius);
      dBodySetMass(bodies_[i], &mass);
      dBodySetGyroscopicMode(bodies_[i], 0);
    }
    joints_.clear();
    for (int k = 0; k < scene_.edges; ++k) {
      joints_.push_back(dJointCreateDBall(world_.get(), nullptr));
      dJointAttach(joints_.back(), bodies_[scene_.edge[2 * k]], bodies_[scene_.edge[2 * k + 1]]);
    }
  }

  // Anchors are kept relative to bodies. Those on pins are places of the world, which can be set
  // again; setting one measures the distance, which is put right after that.
  int put_in(InextensibleStep& step) {
    constexpr dMatrix3 unturned = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (int i = 0; i < vertices; ++i) {
      if (!bodies_[i]) continue;
      const double *x = step.x + 3 * i, *v = step.v + 3 * i;
      dBodySetPosition(bodies_[i], x[0], x[1], x[2]);
      dBodySetLinearVel(bodies_[i], v[0], v[1], v[2]);
      // Nothing turns it, but for a step that overflowed.
      dBodySetRotation(bodies_[i], unturned);
      dBodySetAngularVel(bodies_[i], 0, 0, 0);
      dBodySetForce(bodies_[i], 0, 0, 0);
      dBodySetTorque(bodies_[i], 0, 0, 0);
      if (const double* f = step.force ? step.force + 3 * i : nullptr)
        dBodyAddForce(bodies_[i], f[0], f[1], f[2]);
    }
    for (int k = 0; k < scene_.edges; ++k) {
      const double *a = step.x + 3 * scene_.edge[2 * k], *b = step.x + 3 * scene_.edge[2 * k + 1];
      dJointSetDBallAnchor1(joints_[k], a[0], a[1], a[2]);
      dJointSetDBallAnchor2(joints_[k], b[0], b[1], b[2]);
      dJointSetDBallDistance(joints_[k], scene_.rest_length[k]);
    }
    return INEXTENSIBLE_OK;
  }

  int step(InextensibleStep& step) {
    const bool direct = settings_[solver] == 0;
    dRandSetSeed(random_);
    const int taken =
        direct ? dWorldStep(world_.get(), step.h) : dWorldQuickStep(world_.get(), step.h);
    next_random_ = dRandGetSeed();
    step.iterations = direct ? 1 : passes();
    step.assemblies = step.factorizations = step.back_solves = direct;
    step.edge_projections = direct ? 0 : step.iterations * scene_.edges;
    return taken ? INEXTENSIBLE_OK : INEXTENSIBLE_NOT_FINITE;
  }

  void take_out(InextensibleStep& step) {
    for (int i = 0; i < vertices; ++i) {
      if (!bodies_[i]) continue;
      std::copy_n(dBodyGetPosition(bodies_[i]), 3, step.x + 3 * i);
      std::copy_n(dBodyGetLinearVel(bodies_[i]), 3, step.v + 3 * i);
    }
  }

  void accept() { random_ = next_random_; }

  const int vertices;

 private:
  int passes() const { return static_cast<int>(settings_[iterations]); }

  const InextensibleScene scene_;
  double settings_[5];
  std::unique_ptr<dxWorld, Destroy> world_;
  std::vector<dBodyID> bodies_;   // null: pinned, which is the world to ODE
  std::vector<dJointID> joints_;  // one an edge
  unsigned long random_, next_random_ = 0;
};

const char* const solvers[] = {"direct", "passes", nullptr};
const InextensibleSetting settings[] = {  // iterations and cfm are ODE's own by default
    {"solver", "a factorization (dWorldStep) or passes (dWorldQuickStep)", 0, 0, 0, 0, 0, 0,
     solvers},
    {"iterations", "passes a step", 20, 1, 1e9, 1, 64, 1, nullptr},
    {"relaxation", "of passes", 1.3, 1e-3, 1.999, 0.5, 1.95, 0, nullptr},
    {"erp", "part of an elongation that a step takes back", 1, 0, 1, 0.2, 1, 0, nullptr},
    {"cfm", "compliance over the step, 1 / kg", 1e-10, 0, 1, 0, 0, 0, nullptr}};

}  // namespace

const InextensiblePlugin* inextensible_plugin() {
  dInitODE2(0);
  dSetErrorHandler(throw_error);
  dSetDebugHandler(throw_error);
  dSetMessageHandler([](int, const char*, va_list) {});
  return engines::plugin_of<OdeBalls>(
      "engine_ode", "ODE " ENGINE_VERSION,  // of the package; the library does not say
      "point bodies and joints of fixed distance, double", "joints", "Smith 2001",
      INEXTENSIBLE_TAKES_SHEAR | INEXTENSIBLE_TAKES_BENDING | INEXTENSIBLE_TAKES_DRAG |
          INEXTENSIBLE_WANTS_FORCES,
      INEXTENSIBLE_START, settings);
}
