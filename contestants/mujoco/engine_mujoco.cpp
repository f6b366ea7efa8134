// A chain of hinges in MuJoCo: joint coordinates, so that links keep their length to rounding. A
// link is a body whose mass is a point at its end, and turns on one hinge as long as the chain
// stays in the plane of x and y, on two otherwise. Armature, damping, limits, contacts and
// constraints are off. One step is one mj_step.
// Loops: over links; the mass matrix of a chain is dense, its factorization takes n^3 / 3.
//
// Departure: before each step the links' own axes are turned into the links, so that angles begin
// at 0 and two hinges never come near the place where they are one (gimbal lock). MuJoCo keeps
// nothing else from step to step without constraints.
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "contestants/common/links.h"

namespace {

using engines::Links;

struct Free {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

// MuJoCo's own ends the program, once the user has pressed Enter.
[[noreturn]] void throw_error(const char* message) { throw std::runtime_error(message); }

// Numbers on the stack of a step, more than MuJoCo reserves: the derivatives of the implicit
// integrator need four matrices of a body's six velocities by all joint velocities.
std::size_t stack_size(std::size_t velocities, int integrator) {
  const std::size_t derivatives = integrator == mjINT_IMPLICIT ? 32 * velocities * velocities : 0;
  return 10'000 + 1000 * velocities + derivatives;
}

// MuJoCo's reader nests 100 elements, and takes no more bodies in one file.
constexpr int bodies_a_file = 80;

std::string file_name(int part) { return "links" + std::to_string(part) + ".xml"; }

// Bodies from `first` on, each nested in the one before it; the last one includes the next file.
std::string bodies_text(const Links& links, int hinges, int first) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  const int end = std::min(first + bodies_a_file, links.count());
  for (int i = first; i < end; ++i) {
    text << "<body pos='" << (i == 0 ? 0 : links.length[i - 1]) << " 0 0'>"
         << "<joint type='hinge' axis='0 0 1'/>";
    if (hinges == 2) text << "<joint type='hinge' axis='0 1 0'/>";
    // The inertia is set to 0 after loading; MuJoCo reads none that is not positive.
    text << "<inertial pos='" << links.length[i] << " 0 0' mass='" << links.mass[i]
         << "' diaginertia='1e-9 1e-9 1e-9'/>";
  }
  if (end < links.count()) text << "<include file='" << file_name(end / bodies_a_file) << "'/>";
  for (int i = first; i < end; ++i) text << "</body>";
  return text.str();
}

// The model's files; each includes the next one.
std::vector<std::string> model_files(const Links& links, int integrator) {
  const int hinges = links.flat ? 1 : 2;  // of a link
  const Eigen::Vector3d& gravity = links.gravity;
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "<mujoco><compiler boundmass='0'/><size njmax='1' nconmax='1' nstack='"
       << stack_size(static_cast<std::size_t>(hinges) * links.vertex.size(), integrator)
       << "'/><option gravity='" << gravity.x() << ' ' << gravity.y() << ' ' << gravity.z()
       << "'><flag contact='disable' constraint='disable' warmstart='disable'/></option>"
       << "<worldbody>" << bodies_text(links, hinges, 0) << "</worldbody></mujoco>";
  std::vector<std::string> files{text.str()};
  for (int first = bodies_a_file; first < links.count(); first += bodies_a_file)
    files.push_back("<mujocoinclude>" + bodies_text(links, hinges, first) + "</mujocoinclude>");
  return files;
}

std::unique_ptr<mjModel, Free> load(const std::vector<std::string>& texts) {
  if (texts.size() > mjMAXVFS) throw std::invalid_argument("MuJoCo: too many links to be read");
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string name = file_name(static_cast<int>(i));
    mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(texts[i].size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), name.c_str())], texts[i].data(),
                texts[i].size());
  }
  char error[500] = "";
  std::unique_ptr<mjModel, Free> model;
  try {
    model.reset(mj_loadXML(file_name(0).c_str(), files.get(), error, sizeof(error)));
  } catch (const std::runtime_error& fatal) {
    std::snprintf(error, sizeof(error), "%s", fatal.what());
  }
  mj_deleteVFS(files.get());
  if (!model) {
    std::replace(std::begin(error), std::end(error), '\n', ' ');
    throw std::invalid_argument(std::string("MuJoCo: ") + error);
  }
  return model;
}

struct Integrator {
  const char* name;
  int number;
  int evaluations;     // of the acceleration a step: a mass matrix, its factorization and a solve
  int factorizations;  // beside these
};
constexpr Integrator integrators[] = {
    {"rk4", mjINT_RK4, 4, 0}, {"implicit", mjINT_IMPLICIT, 1, 1}, {"euler", mjINT_EULER, 1, 0}};

class MujocoChain : public engines::Engine {
 public:
  MujocoChain(const InextensibleScene& scene, const double* settings)
      : vertices(scene.vertices),
        links_(scene),
        integrator_(integrators[static_cast<int>(settings[0])]) {
    build();
  }

  void build() {
    built_flat_ = links_.flat;
    model_ = load(model_files(links_, integrator_.number));
    model_->opt.integrator = integrator_.number;
    std::fill_n(model_->body_inertia, 3 * model_->nbody, 0.0);
    data_.reset(mj_makeData(model_.get()));
    if (!data_) throw std::bad_alloc();
  }

  int put_in(InextensibleStep& step) {
    pin_ = engines::columns(step.x, vertices).col(links_.pin);
    if (!links_.find_poses(step.x, step.v)) {
      step.reason = "a link has no direction";
      return INEXTENSIBLE_NOT_FINITE;
    }
    if (built_flat_ != links_.flat) build();
    const int hinges = links_.flat ? 1 : 2;
    Eigen::Quaterniond before = Eigen::Quaterniond::Identity();
    for (int i = 0; i < links_.count(); ++i) {
      const auto& [axes, rate] = links_.poses[i];
      const Eigen::Quaterniond turned(axes);
      const Eigen::Quaterniond against = before.conjugate() * turned;
      mjtNum* quaternion = model_->body_quat + 4 * (i + 1);
      quaternion[0] = against.w();
      for (int c = 0; c < 3; ++c) quaternion[1 + c] = against.vec()[c];
      mjtNum* qvel = data_->qvel + hinges * i;
      qvel[0] = rate.dot(axes.col(2));
      if (hinges == 2) qvel[1] = rate.dot(axes.col(1));
      before = turned;
    }
    mju_zero(data_->qpos, model_->nq);
    std::memset(data_->warning, 0, sizeof(data_->warning));
    return INEXTENSIBLE_OK;
  }

  int step(InextensibleStep& step) {
    model_->opt.timestep = step.h;
    mj_step(model_.get(), data_.get());
    // After one of these warnings MuJoCo has reset itself.
    for (const int warning : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
      if (data_->warning[warning].number == 0) continue;
      step.reason = "MuJoCo met a number above 1e10";
      return INEXTENSIBLE_NOT_FINITE;
    }
    step.iterations = step.assemblies = integrator_.evaluations;
    step.factorizations = step.back_solves = integrator_.evaluations + integrator_.factorizations;
    return INEXTENSIBLE_OK;
  }

  // MuJoCo's chain hangs on the origin.
  void take_out(InextensibleStep& step) {
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
    for (int i = 0; i < links_.count(); ++i) {
      mjtNum spin_and_velocity[6];
      mj_objectVelocity(model_.get(), data_.get(), mjOBJ_BODY, i + 1, spin_and_velocity, 0);
      engines::columns(step.x, vertices).col(links_.vertex[i]) =
          pin_ + Eigen::Map<const Eigen::Vector3d>(data_->xipos + 3 * (i + 1));
      engines::columns(step.v, vertices).col(links_.vertex[i]) =
          Eigen::Map<const Eigen::Vector3d>(spin_and_velocity + 3);
    }
  }

  const int vertices;

 private:
  Links links_;
  bool built_flat_ = false;
  Eigen::Vector3d pin_;
  const Integrator integrator_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

const char* const words[] = {integrators[0].name, integrators[1].name, integrators[2].name,
                             nullptr};
const InextensibleSetting settings[] = {
    {"integrator", "Runge and Kutta's of order 4, implicit in velocities, or semi-implicit", 0, 0,
     0, 0, 0, 0, words}};

}  // namespace

const InextensiblePlugin* inextensible_plugin() {
  mju_user_error = throw_error;
  mju_user_warning = [](const char*) {};  // else it writes them to a file; steps look for them
  return engines::plugin_of<MujocoChain>(
      "engine_mujoco", std::string("MuJoCo ") + mj_versionString(),
      "a chain of hinges (joint coordinates)", "hinges", "Todorov, Erez and Tassa 2012",
      INEXTENSIBLE_WHOLE_STEP, INEXTENSIBLE_UNKNOWN, settings);
}
