// The Python module `inextensible`: bench's scenes, solvers and judge on numpy arrays.
#include <pybind11/stl.h>

#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/python/views.h"
#include "solvers/c_method.h"

namespace inextensible::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

harness::Scene built(const std::string& name, const py::kwargs& parameters) {
  const auto type = harness::find_scene(name);
  if (!type) throw harness::unknown_name("scene", name, names_of(harness::scene_types()));
  harness::SceneParameters given;
  for (const auto& [key, value] : parameters)
    given[py::str(key)] = py::float_(py::reinterpret_borrow<py::object>(value));
  return type->build(complete_parameters(*type, given));
}

struct Scene {
  Scene(const std::string& name, const py::kwargs& parameters) : scene(built(name, parameters)) {
    arrays.scene.x = scene.start.x.data();
    arrays.scene.v = scene.start.v.data();
  }
  const Problem& problem() const { return *scene.problem; }
  Positions positions(const Array& array) const {
    const int vertices = problem().vertices();
    if (array.ndim() != 2 || array.shape(0) != vertices || array.shape(1) != 3)
      throw std::invalid_argument(
          harness::concat("an array must have the shape (", vertices, ", 3)"));
    return Eigen::Map<const Positions>(array.data(), 3, vertices);
  }

  harness::Scene scene;
  SceneArrays arrays{*scene.problem, {}, Along::edges};
};

// What the judge of bench reads off positions and velocities.
py::dict judge(const Scene& scene, const Array& x, const std::optional<Array>& v) {
  const Positions at = scene.positions(x);
  const harness::StrainRange strain = harness::strain_range(scene.problem(), at);
  py::dict figures;
  figures["strain"] = strain.most;
  figures["stretch"] = strain.stretch;
  figures["edge"] = strain.edge;
  figures["potential_energy"] = potential_energy(scene.problem(), at);
  if (v) figures["kinetic_energy"] = kinetic_energy(scene.problem(), scene.positions(*v));
  return figures;
}

// A solver with a state of its own, which begins where bench begins: some methods half a step back.
class Solver {
 public:
  Solver(const Scene& scene, const std::string& name, double strain_limit, std::uint64_t seed,
         const py::kwargs& settings)
      : scene_(scene),
        state_(scene.scene.start),
        options_{strain_limit, seed, settings.cast<Settings>(), &state_},
        stepper_(make_stepper(name, scene.scene.problem, options_)),
        filter_(make_velocity_filter(name, scene.problem(), options_)),
        backend_(*find_backend(name)) {}

  void step(double h) {
    if (!(h > 0)) throw std::invalid_argument("a step must be longer than 0 s");
    if (!begun_ && scene_.scene.staggered)
      state_ = harness::start_from(scene_.problem(), state_, backend_, h);
    begun_ = true;
    check(stepper_->advance(state_, h));
  }

  py::array project(const Array& x_start, const Array& candidate, double h) {
    if (!filter_) throw std::invalid_argument("this solver is a time step of its own, no filter");
    Positions x = scene_.positions(candidate);
    check(filter_->apply(scene_.positions(x_start), h, x, work_));
    return py::array_t<double>({x.cols(), x.rows()}, x.data());
  }

  // A view, until the next step: self is this.
  static py::object view_of(Positions State::*part, const py::object& self) {
    auto& solver = self.cast<Solver&>();
    Positions& vectors = solver.state_.*part;
    return view(vectors.data(), {vectors.cols(), vectors.rows()}, true, self);
  }
  double time() const { return state_.time; }

 private:
  static void check(const StepResult& result) {
    if (!result)
      throw std::runtime_error(harness::concat(to_string(result.status), ": ", result.detail));
  }

  const Scene& scene_;
  State state_;
  BackendOptions options_;
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
  using inextensible::State, py::arg;
  py::register_exception<harness::UsageError>(module, "UsageError", PyExc_ValueError);
  py::class_<Scene>(module, "Scene")
      .def(py::init<const std::string&, const py::kwargs&>(), arg("name"))
      .def("judge", judge, arg("x"), arg("v") = py::none())
      .def("__getattr__", [](const py::object& self, const char* name) -> py::object {
        return scene_views(self.cast<const Scene&>().arrays.scene, self).attr(name);
      });
  py::class_<Solver>(module, "Solver")
      .def(py::init<const Scene&, const std::string&, double, std::uint64_t, const py::kwargs&>(),
           arg("scene"), arg("name"), arg("strain_limit") = 0.01, arg("seed") = 1,
           py::keep_alive<1, 2>())
      .def("step", &Solver::step, arg("h"))
      .def("project", &Solver::project, arg("x_start"), arg("candidate"), arg("h"))
      .def_property_readonly("x", [](const py::object& s) { return Solver::view_of(&State::x, s); })
      .def_property_readonly("v", [](const py::object& s) { return Solver::view_of(&State::v, s); })
      .def_property_readonly("time", &Solver::time);
}
