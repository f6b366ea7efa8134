// Bullet's soft body (btSoftBody), in double precision: nodes and links whose lengths are corrected
// one after the other (PSolve_Links), as in position-based dynamics
// (Mueller et al. 2006). A correction needs no root, so that it is exact to first order only
// (Jakobsen 2001). The world takes one step of h; its damping, sleeping, collisions and limits on
// what a force may move are off.
// Shear, bending and drag, where a scene has them, are forces that bench gives to nodes.
// Loops: `velocity_iterations` + `iterations` passes over links a step.
//
// Departure: none from Bullet, whose world rounds the step to single precision. A node has no
// memory but position and velocity, so that nothing else has to be put back after a refusal.
#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "contestants/common/engine.h"

namespace {

enum Setting { iterations, velocity_iterations, order };

// A world with one body in it.
class BulletSoftBody : public engines::Engine {
 public:
  BulletSoftBody(const InextensibleScene& scene, const double* settings)
      : vertices(scene.vertices) {
    btSoftBodyWorldInfo& info = world_.getWorldInfo();
    info.m_gravity = {scene.gravity[0], scene.gravity[1], scene.gravity[2]};
    info.air_density = info.water_density = 0;
    info.m_maxDisplacement = BT_LARGE_FLOAT;
    const std::vector<btVector3> origin(static_cast<std::size_t>(vertices), btVector3(0, 0, 0));
    body_ = std::make_unique<btSoftBody>(&info, vertices, origin.data(), scene.mass);
    body_->m_materials[0]->m_kLST = 1;
    body_->m_cfg.kDP = 0;
    body_->m_cfg.collisions = 0;
    body_->m_cfg.diterations = 0;
    for (int k = 0; k < scene.edges; ++k) {
      body_->appendLink(scene.edge[2 * k], scene.edge[2 * k + 1]);
      btSoftBody::Link& link = body_->m_links[k];
      link.m_rl = scene.rest_length[k];
      link.m_c1 = link.m_rl * link.m_rl;
    }
    body_->updateLinkConstants();
    body_->m_bUpdateRtCst = false;  // else Bullet takes the first positions for rest lengths
    body_->setActivationState(DISABLE_DEACTIVATION);
    body_->m_cfg.piterations = static_cast<int>(settings[iterations]);
    body_->m_cfg.viterations = static_cast<int>(settings[velocity_iterations]);
    if (body_->m_cfg.viterations > 0)  // by default nothing is done in them
      body_->m_cfg.m_vsequence.push_back(btSoftBody::eVSolver::Linear);
    if (settings[order] == 1) body_->randomizeConstraints();
    world_.addSoftBody(body_.get());
  }
  ~BulletSoftBody() { world_.removeSoftBody(body_.get()); }

  int put_in(InextensibleStep& step) {
    if (btFuzzyZero(step.h)) {
      step.reason = "Bullet takes no step so short";
      return INEXTENSIBLE_NOT_CONVERGED;
    }
    for (int i = 0; i < vertices; ++i) {
      btSoftBody::Node& node = body_->m_nodes[i];
      for (int c = 0; c < 3; ++c) {
        node.m_x[c] = step.x[3 * i + c];
        node.m_v[c] = node.m_im > 0 ? step.v[3 * i + c] : 0;
      }
      if (step.force)
        body_->addForce({step.force[3 * i], step.force[3 * i + 1], step.force[3 * i + 2]}, i);
    }
    return INEXTENSIBLE_OK;
  }

  int step(InextensibleStep& step) {
    world_.stepSimulation(step.h, 0);
    step.iterations = body_->m_cfg.viterations + body_->m_cfg.piterations;
    step.edge_projections = step.iterations * body_->m_links.size();
    return INEXTENSIBLE_OK;
  }

  void take_out(InextensibleStep& step) {
    for (int i = 0; i < vertices; ++i) {
      for (int c = 0; c < 3; ++c) {
        step.x[3 * i + c] = body_->m_nodes[i].m_x[c];
        step.v[3 * i + c] = body_->m_nodes[i].m_v[c];
      }
    }
  }

  const int vertices;

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::unique_ptr<btSoftBody> body_;
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
      INEXTENSIBLE_TAKES_SHEAR | INEXTENSIBLE_TAKES_BENDING | INEXTENSIBLE_TAKES_DRAG |
          INEXTENSIBLE_WANTS_FORCES,
      INEXTENSIBLE_LOCAL, settings);
}
