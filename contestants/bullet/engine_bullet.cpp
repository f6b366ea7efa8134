// Bullet's soft body (btSoftBody), in double precision: nodes and links whose lengths are corrected
// one after the other (PSolve_Links), as in position-based dynamics
// (Mueller et al. 2006). A correction needs no root, so that it is exact to first order only
// (Jakobsen 2001). The world takes one step of h; its damping, sleeping, collisions and limits on
// what a force may move are off.
// Shear, bending and drag, where a scene has them, are forces that the plug-in gives to nodes.
// Loops: `velocity_iterations` + `iterations` passes over links a step.
//
// Departure: none from Bullet, whose world rounds the step to single precision. A node has no
// memory but position and velocity, so that nothing else has to be put back after a refusal.
#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <string>

#include "contestants/common/engine.h"

namespace {

using inextensible::Problem;
using inextensible::Status;

btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

// A world with one body in it.
struct World {
  explicit World(const Problem& problem) {
    btSoftBodyWorldInfo& info = dynamics.getWorldInfo();
    info.m_gravity = to_bullet(problem.gravity());
    info.air_density = info.water_density = 0;
    info.m_maxDisplacement = BT_LARGE_FLOAT;
    std::vector<btScalar> mass = problem.mass();
    for (const int vertex : problem.pinned()) mass[vertex] = 0;  // Bullet's word for infinite
    const std::vector<btVector3> origin(mass.size(), btVector3(0, 0, 0));
    body = std::make_unique<btSoftBody>(&info, problem.vertices(), origin.data(), mass.data());
    body->m_materials[0]->m_kLST = 1;
    body->m_cfg.kDP = 0;
    body->m_cfg.collisions = 0;
    body->m_cfg.diterations = 0;
    for (int k = 0; k < problem.constraints(); ++k) {
      body->appendLink(problem.edges()[k].a, problem.edges()[k].b);
      btSoftBody::Link& link = body->m_links[k];
      link.m_rl = problem.rest_length()[k];
      link.m_c1 = link.m_rl * link.m_rl;
    }
    body->updateLinkConstants();
    body->m_bUpdateRtCst = false;  // else Bullet takes the first positions for rest lengths
    body->setActivationState(DISABLE_DEACTIVATION);
    dynamics.addSoftBody(body.get());
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() { dynamics.removeSoftBody(body.get()); }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld dynamics{&dispatcher, &broadphase, &solver, &configuration};
  std::unique_ptr<btSoftBody> body;
};

class BulletSoftBody final : public engines::EngineStepper {
 public:
  static constexpr const char* name = "engine_bullet";

  BulletSoftBody(std::shared_ptr<const Problem> shared, const inextensible::BackendOptions& options)
      : EngineStepper(std::move(shared)), world_(problem()) {
    const int iterations = options.count("iterations"),
              velocity_iterations = options.count("velocity_iterations");
    world_.body->m_cfg.piterations = iterations;
    world_.body->m_cfg.viterations = velocity_iterations;
    if (velocity_iterations > 0)  // by default nothing is done in them
      world_.body->m_cfg.m_vsequence.push_back(btSoftBody::eVSolver::Linear);
    if (options.word("order") == "random") world_.body->randomizeConstraints();
    passes_ = iterations + velocity_iterations;
  }

  static std::vector<inextensible::SettingInfo> settings() {
    return {{"iterations", 1.0, "passes over links that correct positions (piterations)",
             inextensible::at_least_one, inextensible::SearchRange{1, 32}},
            {"velocity_iterations", 0.0,
             "passes over links before them that correct velocities (viterations)",
             inextensible::count_from_zero, inextensible::SearchRange{0, 8}},
            inextensible::word_setting(
                "order", "mesh", "of links: the mesh's, or shuffled once (randomizeConstraints)",
                {"mesh", "random"})};
  }

 private:
  StepResult put_in(const State& state, double h) override {
    // Bullet takes no step for a time that it calls zero.
    if (btFuzzyZero(h)) return {Status::not_converged, 0, -1, 0, "Bullet takes no step so short"};
    for (int i = 0; i < problem().vertices(); ++i) {
      btSoftBody::Node& node = world_.body->m_nodes[i];
      node.m_x = to_bullet(state.x.col(i));
      node.m_v = to_bullet(state.v.col(i));
    }
    for (const int pin : problem().pinned()) world_.body->m_nodes[pin].m_v.setZero();
    return {};
  }

  void give_force(int vertex, const Eigen::Vector3d& force) override {
    world_.body->addForce(to_bullet(force), vertex);
  }

  StepResult step(double h) override {
    world_.dynamics.stepSimulation(h, 0);
    work_.edge_projections += std::int64_t{passes_} * problem().constraints();
    return {Status::ok, passes_};
  }

  void take_out(const State& /*start*/, Positions& x, Positions& v) override {
    for (int i = 0; i < problem().vertices(); ++i) {
      x.col(i) = from_bullet(world_.body->m_nodes[i].m_x);
      v.col(i) = from_bullet(world_.body->m_nodes[i].m_v);
    }
  }

  World world_;
  int passes_ = 0;
};

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  const std::string version =
      "Bullet " + std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100);
  return engines::plugin_of<BulletSoftBody>(version, "soft body of links (position-based), double",
                                            "soft body", [](inextensible::Backend& row) {
                                              row.takes_shear = row.takes_bending = row.takes_drag =
                                                  true;
                                              row.direction = inextensible::Direction::local;
                                              row.citation = "Coumans 2022";
                                            });
}
