// Solvers in Python as a plug-in (docs/plugins.md). bench loads this library for a file that ends
// in .py, and does not know Python itself. The interpreter begins with the first file and never
// ends; one thread, which calls all of this, holds its lock for good. What solvers raise is made a
// text in loader.py.
#include <pthread.h>
#include <pybind11/embed.h>
#include <pybind11/stl.h>

#include <array>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/python/views.h"

namespace inextensible::python {
namespace {

constexpr const char* loader_source =
#include "loader.inc"  // loader.py as a literal
    ;

// Texts that live until the program ends, as the interface asks.
const char* kept(std::string text) {
  static auto& all = *new std::set<std::string>;
  return all.insert(std::move(text)).first->c_str();
}

const py::dict& loader() {
  static const py::dict& names = *[] {
    py::initialize_interpreter(false, 0, nullptr, false);
    // Children of bench have this thread alone; locks that others held are given up.
    pthread_atfork(nullptr, nullptr, PyOS_AfterFork_Child);
    auto* made = new py::dict;
    (*made)["__builtins__"] = py::module_::import("builtins");
    (*made)["__name__"] = "inextensible_loader";
    py::exec(loader_source, *made);
    return made;
  }();
  return names;
}

struct Solver {
  py::object type;
  std::string method;
  std::vector<InextensibleSetting> settings;
};

std::deque<Solver>& solvers() {
  static auto& all = *new std::deque<Solver>;
  return all;
}

class Object {
 public:
  Object(const Solver& solver, const InextensibleScene& scene, const double* values)
      : vertices_(scene.vertices), call_(loader()["guarded"]), step_(loader()["Step"]()) {
    py::dict settings;
    for (const InextensibleSetting& setting : solver.settings) {
      const double value = *values++;
      settings[setting.name] = setting.whole
                                   ? py::object(py::int_(static_cast<std::int64_t>(value)))
                                   : py::float_(value);
    }
    self_ = call_(solver.type, scene_views(scene), **settings);
    if (py::isinstance<py::str>(self_)) return;
    method_ = self_.attr(solver.method.c_str());
    step_.attr("settle") = py::cpp_function([this] {
      if (current_->settle) current_->settle(current_);
    });
  }

  // What the constructor raised; empty: nothing.
  std::string error() const { return method_ ? "" : self_.cast<std::string>(); }

  int take(InextensibleStep& step) {
    try {
      return taken(step);
    } catch (const py::cast_error&) {
      return refused(step, "a counter of the step is not a whole number");
    }
  }

 private:
  int taken(InextensibleStep& step) {
    const std::pair<const char*, std::int64_t*> counters[] = {
        {"iterations", &step.iterations},
        {"edge_projections", &step.edge_projections},
        {"assemblies", &step.assemblies},
        {"factorizations", &step.factorizations},
        {"back_solves", &step.back_solves}};
    current_ = &step;
    const py::object x = vectors(step.x, true), v = vectors(step.v, true);
    step_.attr("h") = step.h;
    step_.attr("time") = step.time;
    step_.attr("x") = x;
    step_.attr("v") = v;
    step_.attr("x_start") = vectors(step.x_start, false);
    step_.attr("force") = vectors(step.force, false);
    step_.attr("pose") = view(step.pose, {3, 4});
    step_.attr("copy_seconds") = 0.0;
    for (const auto& [name, number] : counters) step_.attr(name) = 0;
    const py::object result = call_(method_, step_);
    for (const auto& [name, number] : counters) *number = step_.attr(name).cast<std::int64_t>();
    step.copy_seconds = step_.attr("copy_seconds").cast<double>();
    if (py::isinstance<py::str>(result)) return refused(step, py::str(result));
    if (!result.is_none()) return refused(step, "the method returned neither None nor a text");
    if (!x.is(step_.attr("x")) || !v.is(step_.attr("v")))
      return refused(step, "step.x or step.v was replaced: write to step.x[:] and step.v[:]");
    return INEXTENSIBLE_OK;
  }

  static int refused(InextensibleStep& step, std::string why) {
    step.reason = kept(std::move(why));
    return INEXTENSIBLE_NOT_CONVERGED;
  }

  // Callers take turns with a few arrays, whose views are made once.
  py::object vectors(const double* data, bool writeable) {
    if (!data) return py::none();
    constexpr std::size_t most = 16;
    if (views_.size() > most) views_.clear();
    py::object& kept_view = views_[{data, writeable}];
    if (!kept_view) kept_view = view(data, {vertices_, 3}, writeable);
    return kept_view;
  }

  py::ssize_t vertices_;
  py::object call_, step_, self_, method_;
  std::map<std::pair<const double*, bool>, py::object> views_;
  InextensibleStep* current_ = nullptr;
};

// The interface's functions. `create` knows its solver by its address.
template <std::size_t Number>
void* create(const InextensibleScene* scene, const double* settings, const char** reason) {
  auto object = std::make_unique<Object>(solvers().at(Number), *scene, settings);
  const std::string error = object->error();
  if (error.empty()) return object.release();
  *reason = kept(error);
  return nullptr;
}

using Create = decltype(InextensibleMethod::create);
template <std::size_t... Numbers>
constexpr auto creators(std::index_sequence<Numbers...> /*all*/) {
  return std::array<Create, sizeof...(Numbers)>{create<Numbers>...};
}
constexpr auto create_of = creators(std::make_index_sequence<64>());

int step(void* object, InextensibleStep* step) { return static_cast<Object*>(object)->take(*step); }
void destroy(void* object) { delete static_cast<Object*>(object); }

// row: what loader.py makes of a class.
InextensibleMethod method_of(const py::handle& row) {
  using Text = std::string;
  const auto [type, call, name, summary, label, citation, kind, flags, direction, settings] =
      row.cast<std::tuple<py::object, Text, Text, Text, Text, Text, int, int, int, py::list>>();
  const std::size_t number = solvers().size();
  if (number == create_of.size()) throw std::length_error("there are more than 64 solvers");
  Solver& solver = solvers().emplace_back(Solver{type, call, {}});
  for (const py::handle setting : settings) {
    using Setting = std::tuple<Text, Text, double, double, double, double, double, bool>;
    const auto [key, meaning, initial, least, largest, from, to, whole] = setting.cast<Setting>();
    solver.settings.push_back(
        {kept(key), kept(meaning), initial, least, largest, from, to, whole, nullptr});
  }
  const auto count = static_cast<std::int32_t>(solver.settings.size());
  return {kept(name), kept(summary), kept(label), kept(citation),         kind,
          flags,      direction,     count,       solver.settings.data(), create_of[number],
          step,       destroy};
}

const InextensiblePlugin* plugin_of(const char* path) {
  const py::object loaded = loader()["guarded"](loader()["load"], path);
  if (py::isinstance<py::str>(loaded)) throw std::runtime_error(loaded.cast<std::string>());
  auto* methods = new std::vector<InextensibleMethod>;  // these live until the program ends
  for (const py::handle row : loaded[py::int_(1)]) methods->push_back(method_of(row));
  return new InextensiblePlugin{INEXTENSIBLE_BUILD, kept(loaded[py::int_(0)].cast<std::string>()),
                                static_cast<std::int32_t>(methods->size()), methods->data()};
}

}  // namespace
}  // namespace inextensible::python

// The table of the file's solvers; null: *error says why there is none. path: an absolute one.
extern "C" __attribute__((visibility("default"))) const InextensiblePlugin* inextensible_python(
    const char* path, const char** error) {
  try {
    return inextensible::python::plugin_of(path);
  } catch (const std::exception& why) {
    *error = inextensible::python::kept(why.what());
    return nullptr;
  }
}
