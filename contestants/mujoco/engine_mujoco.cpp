// A chain of hinges in MuJoCo: joint coordinates, so that links keep their length to rounding. A
// link is a body whose mass is a point at its end, and turns on one hinge as long as the chain
// stays in the plane of x and y, on two otherwise. Contacts and constraints are off. A step is one
// mj_step, by Runge and Kutta's method of order 4 or semi-implicit Euler, MuJoCo's own by default.
// Loops: over links; the mass matrix of a chain is dense, its factorization takes n^3 / 3.
//
// Departure: before each step the links' own axes are turned into the links, so that two hinges
// never come near the place where they are one. MuJoCo keeps nothing else from step to step.
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <stdexcept>

#include "contestants/common/links.h"

namespace {

class MujocoChain {
 public:
  MujocoChain(const InextensibleScene& scene, const double* settings)
      : links_(scene), integrator_(settings[0] == 0 ? mjINT_RK4 : mjINT_EULER) {
    build();
  }

  void put_in(InextensibleStep& step) {
    links_.find_poses(step);
    if (model_->nv != links_.count() * (links_.flat ? 1 : 2)) build();
    for (int i = 0, hinge = 0; i < links_.count(); ++i) {
      const auto& [turn, rate] = links_.poses[i];
      const double quaternion[] = {turn.w(), turn.x(), turn.y(), turn.z()};
      mju_copy4(model_->body_quat + 4 * (i + 1), quaternion);
      data_->qvel[hinge++] = rate.z();
      if (!links_.flat) data_->qvel[hinge++] = rate.y();
    }
    mju_zero(data_->qpos, model_->nq);
    std::memset(data_->warning, 0, sizeof(data_->warning));
  }

  void step(InextensibleStep& step) {
    model_->opt.timestep = step.h;
    mj_step(model_.get(), data_.get());
    for (const int warning : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})
      if (data_->warning[warning].number > 0)
        throw engines::Refusal{INEXTENSIBLE_NOT_FINITE,
                               "MuJoCo reset itself after a number above 1e10"};
    step.iterations = step.assemblies = step.factorizations = step.back_solves =
        integrator_ == mjINT_RK4 ? 4 : 1;  // evaluations of the acceleration
  }

  void take_out(InextensibleStep& step) {
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
    for (int i = 0; i < links_.count(); ++i) {
      double spin_and_velocity[6];
      mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, i + 1, spin_and_velocity, 0);
      mju_add3(step.x + 3 * links_.vertex[i], step.x + 3 * links_.pin, data_->xipos + 3 * (i + 1));
      mju_copy3(step.v + 3 * links_.vertex[i], spin_and_velocity + 3);
    }
  }

 private:
  // Each link is nested in the one before it. MuJoCo's reader nests 100 elements in a file, so that
  // each file of 80 links includes the next one. It reads no inertia of 0.
  void build() {
    std::string text, name, joints = links_.flat ? "<joint/>" : "<joint/><joint axis='0 1 0'/>";
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    for (int i = links_.count() - 1; i >= 0; --i) {
      text = "<body>" + joints + "<inertial pos='1 0 0' mass='1' diaginertia='1 1 1'/>" + text;
      text += "</body>";
      if (i % 80 != 0) continue;
      text = i == 0 ? "<mujoco><worldbody>" + text + "</worldbody></mujoco>"
                    : "<mujocoinclude>" + text + "</mujocoinclude>";
      name = std::to_string(i);
      if (mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(text.size())) != 0)
        throw std::invalid_argument("MuJoCo: too many links to be read");
      std::memcpy(files->filedata[files->nfile - 1], text.data(), text.size());
      text = "<include file='" + name + "'/>";
    }
    model_.reset(mj_loadXML("0", files.get(), nullptr, 0));
    mj_deleteVFS(files.get());
    if (!model_) throw std::invalid_argument("MuJoCo does not read the chain");
    model_->opt.integrator = integrator_;
    model_->opt.disableflags = mjDSBL_CONSTRAINT | mjDSBL_CONTACT;
    mju_copy3(model_->opt.gravity, links_.gravity.data());
    mju_zero(model_->body_inertia, 3 * model_->nbody);
    for (int i = 0; i < links_.count(); ++i) {
      model_->body_mass[i + 1] = links_.mass[i];
      model_->body_ipos[3 * (i + 1)] = links_.length[i];
      if (i > 0) model_->body_pos[3 * (i + 1)] = links_.length[i - 1];
    }
    model_->nstack = 10'000 + 1000 * model_->nv;  // RK4 needs more than MuJoCo reserves
    data_.reset(mj_makeData(model_.get()));
    mj_setConst(model_.get(), data_.get());
  }

  engines::Links links_;
  const int integrator_;
  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model_{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, decltype(&mj_deleteData)> data_{nullptr, mj_deleteData};
};

const char* const integrators[] = {"rk4", "euler", nullptr};
const InextensibleSetting settings[] = {
    {"integrator", "Runge and Kutta's, or semi-implicit", 0, 0, 0, 0, 0, 0, integrators}};

}  // namespace

const InextensiblePlugin* inextensible_plugin() {
  mju_user_error = [](const char* message) { throw std::runtime_error(message); };
  mju_user_warning = [](const char*) {};  // else it writes them to a file; steps look for them
  return engines::plugin_of<MujocoChain>(
      "engine_mujoco", std::string("MuJoCo ") + mj_versionString(),
      "a chain of hinges (joint coordinates)", "hinges", "Todorov, Erez and Tassa 2012",
      INEXTENSIBLE_WHOLE_STEP, INEXTENSIBLE_UNKNOWN, settings);
}
