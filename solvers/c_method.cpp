#include "solvers/c_method.h"

#include <iterator>
#include <stdexcept>
#include <type_traits>

#include "solvers/problem/forces.h"
#include "solvers/problem/triangle_collider.h"

namespace inextensible {
namespace {

static_assert(sizeof(Edge) == 2 * sizeof(std::int32_t) &&
                  sizeof(std::array<int, 3>) == 3 * sizeof(std::int32_t) &&
                  sizeof(Eigen::Vector3d) == 3 * sizeof(double),
              "arrays of these are the interface's");

bool has(const InextensibleMethod& method, int flag) { return (method.flags & flag) != 0; }

// An object of a method. It is replaced after an exception, when its state cannot be trusted.
class Object {
 public:
  // The problem outlives it.
  Object(const InextensibleMethod& method, const Problem& problem, const BackendOptions& options,
         Along along)
      : method_(method), arrays_(problem, options, along) {
    for (int i = 0; i < method.setting_count; ++i) {
      const InextensibleSetting& setting = method.settings[i];
      if (setting.words) {
        const std::string& word = options.word(setting.name);
        settings_.push_back(0);
        while (setting.words[static_cast<int>(settings_.back())] != word) ++settings_.back();
      } else {
        settings_.push_back(options.number(setting.name));
      }
    }
    make();
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() { drop(); }

  // step: with h, time, x and what belongs to them.
  StepResult take(InextensibleStep& step, WorkCounters& work) {
    step.size = sizeof step;
    int result = INEXTENSIBLE_NOT_CONVERGED;
    try {
      result = method_.step(object_, &step);
    } catch (...) {
      drop();
      make();
      step.reason = "the plug-in threw an exception";
    }
    work.edge_projections += step.edge_projections;
    work.assemblies += step.assemblies;
    work.factorizations += step.factorizations;
    work.back_solves += step.back_solves;
    constexpr Status statuses[] = {Status::ok, Status::not_converged, Status::singular,
                                   Status::not_finite};
    if (result < 0 || result >= static_cast<int>(std::size(statuses)))
      return {Status::not_converged, 0, -1, 0, "the plug-in returned an unknown result"};
    return {statuses[result], static_cast<int>(step.iterations), -1, 0,
            step.reason ? step.reason
            : result    ? "the plug-in gave no reason"
                        : ""};
  }

 private:
  void make() {
    const char* reason = nullptr;
    object_ = method_.create(&arrays_.scene, settings_.data(), &reason);
    if (!object_)
      throw std::invalid_argument(std::string("solver '") + method_.name +
                                  "' does not take this scene" + (reason ? ": " : "") +
                                  (reason ? reason : ""));
  }
  void drop() {
    if (object_) method_.destroy(object_);
    object_ = nullptr;
  }

  const InextensibleMethod& method_;
  SceneArrays arrays_;
  std::vector<double> settings_;
  void* object_ = nullptr;
};

class CFilter final : public VelocityFilter {
 public:
  CFilter(const InextensibleMethod& method, const Problem& problem, const BackendOptions& options,
          Along along)
      : pinned_(problem.pinned()), object_(method, problem, options, along) {}

  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override {
    pins_ = x.positions()(Eigen::all, pinned_);
    Call call{{}, x};
    call.step.h = h;
    call.step.x = x.positions().data();
    call.step.x_start = x_start.data();
    if (x.contacts()) {
      call.step.settle = [](InextensibleStep* step) {
        reinterpret_cast<Call*>(step)->x.settle();  // the first member of a Call
      };
    }
    const StepResult result = object_.take(call.step, work);
    x.positions()(Eigen::all, pinned_) = pins_;
    return result;
  }

 private:
  struct Call {
    InextensibleStep step;
    Iterate x;
  };
  static_assert(std::is_standard_layout_v<Call>);

  const std::vector<int>& pinned_;
  Object object_;
  Positions pins_;
};

class CStepper final : public ForeignStepper {
 public:
  CStepper(const InextensibleMethod& method, std::shared_ptr<const Problem> shared,
           const BackendOptions& options)
      : ForeignStepper(std::move(shared)), object_(method, problem(), options, Along::edges) {
    const bool forces = problem().shear() || !problem().bending().empty() || problem().has_drag();
    if (forces && has(method, INEXTENSIBLE_WANTS_FORCES)) forces_.resize(3, problem().vertices());
  }

 private:
  StepResult take(const State& state, InextensibleStep& step) override {
    if (forces_.size() > 0) {
      find_forces(state);
      step.force = forces_.data();
    }
    return object_.take(step, work_);
  }

  // All but the weight.
  void find_forces(const State& state) {
    forces_.setZero();
    add_forces(problem(), state.x, state.x, state.v, forces_, work_);
    for (int i = 0; i < problem().vertices(); ++i)
      forces_.col(i) -= problem().mass()[i] * problem().gravity();
    for (const int pin : problem().pinned()) forces_.col(pin).setZero();
  }

  Object object_;
  Positions forces_;  // empty where nothing wants them
};

}  // namespace

SceneArrays::SceneArrays(const Problem& problem, const BackendOptions& options, Along along) {
  scene.size = sizeof scene;
  scene.vertices = problem.vertices();
  scene.strain_limit = options.strain_limit;
  scene.seed = options.seed;
  std::copy(problem.gravity().begin(), problem.gravity().end(), scene.gravity);
  mass = problem.mass();
  for (const int pin : problem.pinned()) mass[pin] = 0;
  scene.mass = mass.data();
  scene.edges = problem.constraints();
  scene.edge = &problem.edges().data()->a;
  scene.rest_length = problem.rest_length().data();
  if (const Springs* shear = problem.shear()) {
    scene.springs = static_cast<std::int32_t>(shear->edges.size());
    scene.spring = &shear->edges.data()->a;
    scene.spring_length = shear->rest_length.data();
    scene.spring_stiffness = shear->stiffness.data();
  }
  for (const BendingStencil& stencil : problem.bending()) {
    stencils.insert(stencils.end(), stencil.vertex.begin(), stencil.vertex.end());
    coefficients.insert(coefficients.end(), stencil.coefficient.begin(), stencil.coefficient.end());
    stiffness.push_back(stencil.stiffness);
  }
  scene.stencils = static_cast<std::int32_t>(stiffness.size());
  scene.stencil = stencils.data();
  scene.stencil_coefficient = coefficients.data();
  scene.stencil_stiffness = stiffness.data();
  if (problem.has_drag()) {
    for (int i = 0; i < problem.vertices(); ++i) drag.push_back(problem.drag(i));
    scene.drag = drag.data();
  }
  if (problem.collider()) add_body(problem);
  scene.along_middle = along == Along::middle;
  if (!options.start) return;
  start = *options.start;
  scene.x = start.x.data();
  scene.v = start.v.data();
}

void SceneArrays::add_body(const Problem& problem) {
  const auto* body = dynamic_cast<const TriangleCollider*>(problem.collider());
  if (!body) throw std::invalid_argument("the collider is not a triangle mesh");
  scene.body_vertices = static_cast<std::int32_t>(body->mesh().vertices.size());
  scene.body_vertex = body->mesh().vertices.data()->data();
  scene.body_triangles = body->triangles();
  scene.body_triangle = body->mesh().triangles.data()->data();
  scene.friction = body->friction();
  scene.body_moves = static_cast<bool>(problem.body_motion());
}

StepResult ForeignStepper::solve(const State& state, double h, Positions& x) {
  Stopwatch stopwatch(phases_wanted_);
  x = state.x;
  v_ = state.v;
  InextensibleStep step{};
  step.h = h;
  step.time = state.time;
  step.x = x.data();
  step.v = v_.data();
  if (const BodyMotion& motion = problem().body_motion()) {
    const Pose pose = motion(state.time + h);
    pose_ << pose.turn, pose.translation;
    step.pose = pose_.data();
  }
  phases_.unconstrained += stopwatch();
  const StepResult taken = take(state, step);
  for (const int pin : problem().pinned()) {
    x.col(pin) = state.x.col(pin);
    v_.col(pin).setZero();
  }
  phases_.filter += stopwatch() - step.copy_seconds;
  phases_.copy += step.copy_seconds;
  x_ = x;
  return taken;
}

// What the collision filter has moved, it has moved in a step.
StepResult ForeignStepper::end_velocities(const State& start, double h, const Positions& x,
                                          Positions& v) {
  v = v_ + (x - x_) * (1 / h);
  for (const int pin : problem().pinned()) v.col(pin) = (x.col(pin) - start.x.col(pin)) / h;
  return {};
}

SettingInfo setting_of(const std::string& solver, const InextensibleSetting& setting) {
  const auto check = [&](bool fits, const char* what) {
    if (!fits)
      throw std::invalid_argument("solver '" + solver + "', setting '" +
                                  (setting.name ? setting.name : "") + "' " + what);
  };
  check(setting.name && setting.meaning, "has no name or no meaning");
  SettingInfo info{.name = setting.name, .initial = setting.initial, .meaning = setting.meaning};
  if (setting.words) {
    for (const char* const* word = setting.words; *word; ++word) info.choices.push_back(*word);
    const auto place = static_cast<std::size_t>(setting.initial);
    check(setting.initial >= 0 && place < info.choices.size(), "begins with a word that it lacks");
    info.initial = info.choices[place];
    return info;
  }
  info.range = {.whole = setting.whole != 0};
  info.range.least = -info.range.largest;
  if (setting.least != 0 || setting.largest != 0) {
    info.range.least = setting.least;
    info.range.largest = setting.largest;
  }
  check(info.range.contains(setting.initial), "begins outside its range");
  if (setting.search_least != 0 || setting.search_largest != 0) {
    check(setting.search_least < setting.search_largest &&
              info.range.contains(setting.search_least) &&
              info.range.contains(setting.search_largest),
          "has a search range that is empty or outside its range");
    info.tunable = {setting.search_least, setting.search_largest};
  }
  return info;
}

Backend row_of(const InextensibleMethod& method) {
  const std::string name = method.name ? method.name : "";
  if (!method.create || !method.step || !method.destroy)
    throw std::invalid_argument("solver '" + name + "' lacks create, step or destroy");
  if (method.kind != INEXTENSIBLE_STEP && method.kind != INEXTENSIBLE_FILTER)
    throw std::invalid_argument("solver '" + name + "' is neither a step nor a filter");
  constexpr Direction directions[] = {Direction::none, Direction::local, Direction::start,
                                      Direction::current, Direction::end};
  if (method.direction < 0 || method.direction >= static_cast<int>(std::size(directions)))
    throw std::invalid_argument("solver '" + name + "' has an unknown direction");
  const bool filter = method.kind == INEXTENSIBLE_FILTER;
  const bool engine = has(method, INEXTENSIBLE_ENGINE);
  Backend row{.name = method.name, .summary = method.summary};
  if (has(method, INEXTENSIBLE_NO_LIMIT)) row.strain_control = StrainControl::time_step;
  for (int i = 0; i < method.setting_count; ++i)
    row.settings.push_back(setting_of(name, method.settings[i]));
  if (filter) {
    row.make_filter = [&method](const Problem& problem, const BackendOptions& options,
                                Along along) {
      return std::make_unique<CFilter>(method, problem, options, along);
    };
  } else {
    row.make = [&method](std::shared_ptr<const Problem> problem, const BackendOptions& options) {
      return std::make_unique<CStepper>(method, std::move(problem), options);
    };
  }
  row.takes_middle = has(method, INEXTENSIBLE_TAKES_MIDDLE);
  row.direction = directions[method.direction];
  row.citation = method.citation;
  row.origin = engine ? Origin::engine : Origin::elsewhere;
  row.label = method.label;
  row.family = engine ? "engines" : "";
  row.takes_collider = has(method, INEXTENSIBLE_TAKES_COLLIDER);
  row.takes_shear = filter || has(method, INEXTENSIBLE_TAKES_SHEAR);
  row.takes_bending = filter || has(method, INEXTENSIBLE_TAKES_BENDING);
  row.takes_drag = filter || has(method, INEXTENSIBLE_TAKES_DRAG);
  row.takes_implicit_forces = filter || has(method, INEXTENSIBLE_TAKES_STIFF_FORCES);
  if (has(method, INEXTENSIBLE_WHOLE_STEP)) row.velocities = Velocities::whole_step;
  row.conserves_momentum = has(method, INEXTENSIBLE_MOMENTUM);
  return row;
}

}  // namespace inextensible
