// The Python module `inextensible`: bench's scenes, solvers and judge on numpy arrays.
#include <pybind11/stl.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/python/views.h"
#include "solvers/c_method.h"
#include "solvers/problem/forces.h"

namespace inextensible::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

Positions positions_of(const Array& array, int vertices) {
  if (array.ndim() != 2 || array.shape(0) != vertices || array.shape(1) != 3)
    throw std::invalid_argument(
        harness::concat("an array must have the shape (", vertices, ", 3)"));
  return Eigen::Map<const Positions>(array.data(), 3, vertices);
}

struct HeldScene {
  explicit HeldScene(harness::Scene built) : scene(std::move(built)) {
    arrays.scene.x = scene.start.x.data();
    arrays.scene.v = scene.start.v.data();
  }
  harness::Scene scene;
  SceneArrays arrays{*scene.problem, {}, Along::edges};
};

class Scene {
 public:
  Scene(const std::string& name, const py::kwargs& parameters) {
    const auto type = harness::find_scene(name);
    if (!type) {
      std::vector<std::string> known;
      for (const auto& scene : harness::scene_types()) known.push_back(scene.name);
      throw harness::unknown_name("scene", name, known);
    }
    harness::SceneParameters given;
    for (const auto& [key, value] : parameters)
      given[py::str(key)] = py::float_(py::reinterpret_borrow<py::object>(value));
    held_ = std::make_shared<HeldScene>(type->build(complete_parameters(*type, given)));
    // Arrays keep what they are views of.
    using Held = std::shared_ptr<HeldScene>;
    views_ =
        scene_views(held_->arrays.scene,
                    py::capsule(new Held(held_), [](void* p) { delete static_cast<Held*>(p); }));
  }

  py::object attribute(const std::string& name) const { return views_.attr(name.c_str()); }
  const harness::Scene& scene() const { return held_->scene; }
  int vertices() const { return scene().problem->vertices(); }

  // What the judge of bench reads off positions and velocities.
  py::dict judge(const Array& x, const py::object& v) const {
    const Problem& problem = *scene().problem;
    const Positions at = positions_of(x, vertices());
    const harness::StrainRange strain = harness::strain_range(problem, at);
    py::dict figures;
    figures["strain"] = strain.most;
    figures["stretch"] = strain.stretch;
    figures["edge"] = strain.edge;
    figures["potential_energy"] = potential_energy(problem, at);
    if (!v.is_none())
      figures["kinetic_energy"] =
          kinetic_energy(problem, positions_of(v.cast<Array>(), vertices()));
    return figures;
  }

 private:
  std::shared_ptr<HeldScene> held_;
  py::object views_;
};

// A solver with a state of its own, which begins where bench begins: some methods half a step back.
class Solver {
 public:
  Solver(const Scene& scene, const std::string& name, double strain_limit, std::uint64_t seed,
         const py::kwargs& settings)
      : scene_(scene),
        options_{strain_limit, seed, settings.cast<Settings>(), &scene.scene().start},
        state_(scene.scene().start),
        stepper_(make_stepper(name, scene_.scene().problem, options_)),
        filter_(make_velocity_filter(name, *scene_.scene().problem, options_)),
        backend_(*find_backend(name)) {}

  void step(double h) {
    if (!(h > 0)) throw std::invalid_argument("a step must be longer than 0 s");
    if (!begun_) state_ = harness::start_of(scene_.scene(), backend_, h);
    begun_ = true;
    check(stepper_->advance(state_, h));
  }

  py::array project(const Array& x_start, const Array& candidate, double h) {
    if (!filter_) throw std::invalid_argument("this solver is a time step of its own, no filter");
    Positions x = positions_of(candidate, scene_.vertices());
    check(filter_->apply(positions_of(x_start, scene_.vertices()), h, x, work_));
    return py::array_t<double>({scene_.vertices(), 3}, x.data());
  }

  // A view, until the next step: self is this.
  static py::object view_of(Positions State::*part, const py::object& self) {
    auto& solver = self.cast<Solver&>();
    return view((solver.state_.*part).data(), {solver.scene_.vertices(), 3}, true, self);
  }
  double time() const { return state_.time; }
  std::int64_t iterations() const { return stepper_->work().iterations + work_.iterations; }

 private:
  static void check(const StepResult& result) {
    if (!result)
      throw std::runtime_error(harness::concat(to_string(result.status), ": ", result.detail));
  }

  Scene scene_;  // what the solver refers to lives in it
  BackendOptions options_;
  State state_;
  std::unique_ptr<Stepper> stepper_;
  std::unique_ptr<VelocityFilter> filter_;
  const Backend& backend_;
  WorkCounters work_;
  bool begun_ = false;
};

}  // namespace
}  // namespace inextensible::python

PYBIND11_MODULE(inextensible, module) {
  using namespace inextensible::python;
  using inextensible::State;
  using py::arg;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const harness::UsageError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  module.doc() = "Scenes, solvers and the judge of bench.";
  py::class_<Scene>(module, "Scene")
      .def(py::init<const std::string&, const py::kwargs&>(), arg("name"))
      .def("judge", &Scene::judge, arg("x"), arg("v") = py::none())
      .def("__getattr__", &Scene::attribute);
  py::class_<Solver>(module, "Solver")
      .def(py::init<const Scene&, const std::string&, double, std::uint64_t, const py::kwargs&>(),
           arg("scene"), arg("name"), arg("strain_limit") = 0.01, arg("seed") = 1)
      .def("step", &Solver::step, arg("h"))
      .def("project", &Solver::project, arg("x_start"), arg("candidate"), arg("h"))
      .def_property_readonly("x", [](const py::object& s) { return Solver::view_of(&State::x, s); })
      .def_property_readonly("v", [](const py::object& s) { return Solver::view_of(&State::v, s); })
      .def_property_readonly("time", &Solver::time)
      .def_property_readonly("iterations", &Solver::iterations);
}
