// SPDX-License-Identifier: Apache-2.0
// python/module.h: what the files of the extension module share: the bindings, conversions between
// Python and the public API, and classes whose objects only C++ can make.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "nacre.h"
#include "python/guard.h"

namespace nacre_python {

void BindImages(py::module_* module);
void BindScenes(py::module_* module);
void BindBrdfs(py::module_* module);
void BindTables(py::module_* module);

// A scene and the calls that work on it.
struct Scene {
  nacre::Scene scene;
  mutable Users users;
};

// Parameters by name, each with its value as JSON text.
using Members = std::vector<std::pair<std::string, std::string>>;
nacre::Parameters ParametersOf(const Members& members);

// To and from an object of Python's class nacre.Image.
py::object ToPython(nacre::Image&& image);
nacre::Image FromPython(const py::object& image);

// Wraps the functions of a nacre.Brdf: evaluate(normal, to_view, to_light) and, unless they are
// None, sample(normal, to_view, u) and pdf(normal, to_view, to_light). They take arrays of shape
// (count, 3) or (count, 2) and return arrays of shape (3, count) or (count,), all float64.
nacre::UserBrdf UserBrdfOf(const py::object& evaluate, const py::object& sample,
                           const py::object& pdf);

// An array of shape (3, count) with x, y and z of each vector.
using Planes = py::array_t<double, py::array::c_style | py::array::forcecast>;

// The package passes arrays of the right shape, but users can change them before they are used.
inline void RequireShape(const py::array& array, size_t rows, size_t columns) {
  const bool right = array.ndim() == 2 && static_cast<size_t>(array.shape(0)) == rows &&
                     static_cast<size_t>(array.shape(1)) == columns;
  if (!right) {
    throw py::value_error("nacre: an array is not of the shape (" + std::to_string(rows) + ", " +
                          std::to_string(columns) + ")");
  }
}

// ---- Texts and file names, which may be in any encoding -----------------------------------------

// Like os.fsdecode: bytes that are not UTF-8 become surrogates, which convert back to the same
// bytes.
inline py::str TextOf(const std::string& bytes) {
  PyObject* const text =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape");
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

inline std::string BytesOf(const py::handle& text) {
  PyObject* const bytes = PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape");
  if (bytes == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::bytes>(bytes);
}

// ---- Classes whose objects only C++ can make ----------------------------------------------------

// To be called when a class has all of its functions. Prevents `__new__` without a constructor,
// which would make an empty object, subclasses, whose objects might hold something else, and
// changes of `__class__`, which would give an object another class's memory: calls would read all
// of these.
inline void Seal(const py::handle& type) {
  auto* const object = reinterpret_cast<PyTypeObject*>(type.ptr());
  object->tp_new = [](PyTypeObject*, PyObject*, PyObject*) -> PyObject* {
    PyErr_SetString(PyExc_TypeError, "nacre: the package's own functions make such an object");
    return nullptr;
  };
  object->tp_flags &= ~Py_TPFLAGS_BASETYPE;
#ifdef Py_TPFLAGS_IMMUTABLETYPE  // Python 3.10
  object->tp_flags |= Py_TPFLAGS_IMMUTABLETYPE;
#endif
  PyType_Modified(object);
}

}  // namespace nacre_python
