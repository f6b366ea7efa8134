// Bullet's soft body (btSoftBody), in double precision: nodes and links whose lengths are corrected
// one after the other (PSolve_Links), as in position-based dynamics (Mueller et al. 2006). A
// correction needs no root, so that it is exact to first order only (Jakobsen 2001). The world
// takes one step of h; its damping, sleeping, collisions and limits on what a force may move are
// off. Shear, bending and drag, where a scene has them, are forces that bench gives to nodes.
// Loops: `velocity_iterations` + `iterations` passes over links a step.
//
// Departure: none from Bullet, whose world rounds the step to single precision. A node has no
// memory but position and velocity, so that nothing else has to be put back after a refusal.
#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <vector>

#include "contestants/common/engine.h"

namespace {

enum Setting { iterations, velocity_iterations, order };

// A world with one body in it.
class BulletSoftBody {
 public:
  BulletSoftBody(const InextensibleScene& scene, const double* settings)
      : body_(&world_.getWorldInfo(), scene.vertices,
              std::vector<btVector3>(scene.vertices, btVector3(0, 0, 0)).data(), scene.mass) {
    btSoftBodyWorldInfo& info = world_.getWorldInfo();
    info.m_gravity = {scene.gravity[0], scene.gravity[1], scene.gravity[2]};
    info.air_density = info.water_density = 0;
    info.m_maxDisplacement = BT_LARGE_FLOAT;
    body_.m_materials[0]->m_kLST = 1;
    for (int k = 0; k < scene.edges; ++k) {
      body_.appendLink(scene.edge[2 * k], scene.edge[2 * k + 1]);
      body_.m_links[k].m_rl = scene.rest_length[k];
      body_.m_links[k].m_c1 = scene.rest_length[k] * scene.rest_length[k];
    }
    body_.updateLinkConstants();
    body_.m_bUpdateRtCst = false;  // else Bullet takes the first positions for rest lengths
    body_.setActivationState(DISABLE_DEACTIVATION);
    body_.m_cfg.kDP = 0;
    body_.m_cfg.collisions = body_.m_cfg.diterations = 0;
    body_.m_cfg.piterations = static_cast<int>(settings[iterations]);
    body_.m_cfg.viterations = static_cast<int>(settings[velocity_iterations]);
    if (body_.m_cfg.viterations > 0)  // by default nothing is done in them
      body_.m_cfg.m_vsequence.push_back(btSoftBody::eVSolver::Linear);
    if (settings[order] == 1) body_.randomizeConstraints();
    world_.addSoftBody(&body_);
  }
  BulletSoftBody(const BulletSoftBody&) = delete;
  BulletSoftBody& operator=(const BulletSoftBody&) = delete;
  ~BulletSoftBody() { world_.removeSoftBody(&body_); }

  void put_in(InextensibleStep& step) {
    if (btFuzzyZero(step.h))
      throw engines::Refusal{INEXTENSIBLE_NOT_CONVERGED, "Bullet takes no step so short"};
    for (int i = 0; i < body_.m_nodes.size(); ++i) {
      btSoftBody::Node& node = body_.m_nodes[i];
      std::copy_n(step.x + 3 * i, 3, node.m_x.m_floats);
      node.m_v.setZero();
      if (node.m_im > 0) std::copy_n(step.v + 3 * i, 3, node.m_v.m_floats);
      if (const double* force = step.force ? step.force + 3 * i : nullptr)
        body_.addForce({force[0], force[1], force[2]}, i);
    }
  }

  void step(InextensibleStep& step) {
    world_.stepSimulation(step.h, 0);
    step.iterations = body_.m_cfg.viterations + body_.m_cfg.piterations;
    step.edge_projections = step.iterations * body_.m_links.size();
  }

  void take_out(InextensibleStep& step) {
    for (int i = 0; i < body_.m_nodes.size(); ++i) {
      std::copy_n(body_.m_nodes[i].m_x.m_floats, 3, step.x + 3 * i);
      std::copy_n(body_.m_nodes[i].m_v.m_floats, 3, step.v + 3 * i);
    }
  }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btSoftBody body_;
};

const char* const orders[] = {"mesh", "random", nullptr};
const InextensibleSetting settings[] = {
    {"iterations", "passes over links that correct positions (piterations)", 1, 1, 1e9, 1, 32, 1,
     nullptr},
    {"velocity_iterations", "passes over links before them that correct velocities (viterations)",
     0, 0, 1e9, 0, 8, 1, nullptr},
    {"order", "of links: the mesh's, or shuffled once (randomizeConstraints)", 0, 0, 0, 0, 0, 0,
     orders}};

}  // namespace

const InextensiblePlugin* inextensible_plugin() {
  return engines::plugin_of<BulletSoftBody>(
      "engine_bullet",
      "Bullet " + std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100),
      "soft body of links (position-based), double", "soft body", "Coumans 2022",
      engines::takes_forces, INEXTENSIBLE_LOCAL, settings);
}
