// numpy arrays on memory of bench, without copies.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "solvers/inextensible.h"

namespace inextensible::python {

namespace py = pybind11;

inline py::object read_only(py::object array) {
  array.attr("flags").attr("writeable") = false;
  return array;
}

// A view; None where there is nothing. Without an owner, which it keeps alive, it must not be used
// for longer than the memory lives.
template <class Number>
py::object view(const Number* data, std::vector<py::ssize_t> shape, bool writeable = false,
                const py::object& owner = py::none()) {
  if (!data || shape[0] == 0) return py::none();
  const py::object array = py::array_t<Number>(std::move(shape), data, owner);
  return writeable ? array : read_only(array);
}

// The attributes `scene` of a solver, read-only: views that live as long as the scene's arrays, and
// copies of x and v, which need not.
inline py::object scene_views(const InextensibleScene& s, const py::object& owner = py::none()) {
  py::dict d;
  const auto rows = [&owner](const auto* data, std::int32_t count, std::int32_t columns) {
    return view(data, {count, columns}, false, owner);
  };
  const auto numbers = [&owner](const double* data, std::int32_t count) {
    return view(data, {count}, false, owner);
  };
  const auto copy = [](const py::object& array) {
    return array.is_none() ? array : read_only(array.attr("copy")());
  };
  d["vertices"] = s.vertices;
  d["gravity"] = copy(numbers(s.gravity, 3));
  d["mass"] = numbers(s.mass, s.vertices);
  py::array_t<double> inverse_mass(s.vertices);  // 0: pinned
  for (std::int32_t i = 0; i < s.vertices; ++i)
    inverse_mass.mutable_at(i) = s.mass[i] > 0 ? 1 / s.mass[i] : 0;
  d["inverse_mass"] = read_only(inverse_mass);
  d["x"] = copy(rows(s.x, s.vertices, 3));
  d["v"] = copy(rows(s.v, s.vertices, 3));
  d["edges"] = rows(s.edge, s.edges, 2);
  d["rest_length"] = numbers(s.rest_length, s.edges);
  d["springs"] = rows(s.spring, s.springs, 2);
  d["spring_length"] = numbers(s.spring_length, s.springs);
  d["spring_stiffness"] = numbers(s.spring_stiffness, s.springs);
  d["stencils"] = rows(s.stencil, s.stencils, 4);
  d["stencil_coefficients"] = rows(s.stencil_coefficient, s.stencils, 4);
  d["stencil_stiffness"] = numbers(s.stencil_stiffness, s.stencils);
  d["drag"] = numbers(s.drag, s.vertices);
  d["body_vertices"] = rows(s.body_vertex, s.body_vertices, 3);
  d["body_triangles"] = rows(s.body_triangle, s.body_triangles, 3);
  d["friction"] = s.friction;
  d["body_moves"] = s.body_moves != 0;
  d["along_middle"] = s.along_middle != 0;
  d["strain_limit"] = s.strain_limit;
  d["seed"] = s.seed;
  return py::module_::import("types").attr("SimpleNamespace")(**d);
}

}  // namespace inextensible::python
