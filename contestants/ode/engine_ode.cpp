// ODE, in double precision: a body of a point mass a vertex, and a joint that keeps the distance of
// two centres (DBall) an edge. A step is semi-implicit Euler's; multipliers make the velocity at
// its end one that takes the part `erp` of each elongation back, along directions at its start.
// They come from a factorization of the dense matrix (dWorldStep), or from passes of successive
// over-relaxation in random order, from 0 (dWorldQuickStep). ODE damps and disables nothing by
// default; there are no geometries. Shear, bending and drag are forces that bench gives to bodies.
// Loops: over joints, `iterations` passes; "direct" m^3 / 6 for m edges.
//
// Departure: ODE's random numbers are one sequence for the program; here each step begins it with
// the seed.
#include <ode/ode.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include "contestants/common/engine.h"

namespace {

enum Setting { solver, iterations, relaxation, erp, cfm };

class OdeBalls {
 public:
  OdeBalls(const InextensibleScene& scene, const double* settings)
      : scene_(scene), direct_(settings[solver] == 0) {
    dAllocateODEDataForThread(dAllocateMaskAll);
    world_.reset(dWorldCreate());
    dWorldSetGravity(world_.get(), scene.gravity[0], scene.gravity[1], scene.gravity[2]);
    dWorldSetERP(world_.get(), settings[erp]);
    dWorldSetCFM(world_.get(), settings[cfm]);
    dWorldSetQuickStepNumIterations(world_.get(), static_cast<int>(settings[iterations]));
    dWorldSetQuickStepW(world_.get(), settings[relaxation]);
    for (int i = 0; i < scene.vertices; ++i) {
      bodies_.push_back(scene.mass[i] == 0 ? nullptr : dBodyCreate(world_.get()));
      if (!bodies_[i]) continue;
      dMass mass;  // ODE wants an inertia; nothing turns a body whose joints act on its centre
      dMassSetSphereTotal(&mass, scene.mass[i], 1);
      dBodySetMass(bodies_[i], &mass);
    }
    for (int k = 0; k < scene.edges; ++k) {
      joints_.push_back(dJointCreateDBall(world_.get(), nullptr));
      dJointAttach(joints_[k], bodies_[scene.edge[2 * k]], bodies_[scene.edge[2 * k + 1]]);
    }
  }

  // Anchors are kept relative to bodies. Those on pins are places of the world, which can be set
  // again; setting one measures the distance, that is put right after that.
  void put_in(InextensibleStep& step) {
    constexpr dMatrix3 unturned = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (int i = 0; i < scene_.vertices; ++i) {
      if (!bodies_[i]) continue;
      const double *x = step.x + 3 * i, *v = step.v + 3 * i;
      dBodySetPosition(bodies_[i], x[0], x[1], x[2]);
      dBodySetLinearVel(bodies_[i], v[0], v[1], v[2]);
      dBodySetRotation(bodies_[i], unturned);  // nothing turns it but a step that overflows
      dBodySetAngularVel(bodies_[i], 0, 0, 0);
      if (const double* f = step.force ? step.force + 3 * i : nullptr)
        dBodyAddForce(bodies_[i], f[0], f[1], f[2]);
    }
    for (int k = 0; k < scene_.edges; ++k) {
      const double *a = step.x + 3 * scene_.edge[2 * k], *b = step.x + 3 * scene_.edge[2 * k + 1];
      dJointSetDBallAnchor1(joints_[k], a[0], a[1], a[2]);
      dJointSetDBallAnchor2(joints_[k], b[0], b[1], b[2]);
      dJointSetDBallDistance(joints_[k], scene_.rest_length[k]);
    }
  }

  void step(InextensibleStep& step) {
    dRandSetSeed(scene_.seed);
    if (!(direct_ ? dWorldStep : dWorldQuickStep)(world_.get(), step.h))
      throw engines::Refusal{INEXTENSIBLE_NOT_CONVERGED, "ODE took no step"};
    step.iterations = direct_ ? 1 : dWorldGetQuickStepNumIterations(world_.get());
    step.assemblies = step.factorizations = step.back_solves = direct_;
    step.edge_projections = direct_ ? 0 : step.iterations * scene_.edges;
  }

  void take_out(InextensibleStep& step) {
    for (int i = 0; i < scene_.vertices; ++i) {
      if (!bodies_[i]) continue;
      std::copy_n(dBodyGetPosition(bodies_[i]), 3, step.x + 3 * i);
      std::copy_n(dBodyGetLinearVel(bodies_[i]), 3, step.v + 3 * i);
    }
  }

 private:
  const InextensibleScene scene_;
  const bool direct_;
  std::unique_ptr<dxWorld, decltype(&dWorldDestroy)> world_{nullptr, dWorldDestroy};
  std::vector<dBodyID> bodies_;   // null: pinned, which is the world to ODE
  std::vector<dJointID> joints_;  // one an edge
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
  const auto fail = [](int, const char*, va_list) {  // ODE's own ends the program
    throw std::runtime_error("ODE met numbers that it does not take");
  };
  dSetErrorHandler(fail);
  dSetDebugHandler(fail);
  dSetMessageHandler([](int, const char*, va_list) {});
  return engines::plugin_of<OdeBalls>(
      "engine_ode", "ODE " ENGINE_VERSION,  // of the package; the library does not say
      "point bodies and joints of fixed distance, double", "joints", "Smith 2001",
      engines::takes_forces, INEXTENSIBLE_START, settings);
}
