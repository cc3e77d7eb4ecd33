// SPDX-License-Identifier: Apache-2.0
// python/sealed.h: classes whose objects only C++ can make.
#pragma once

#include <pybind11/pybind11.h>

namespace nacre_python {

// To be called when a class has all of its functions. Prevents `__new__` without a constructor,
// which would make an empty object, subclasses, whose objects might hold something else, and
// changes of `__class__`, which would give an object another class's memory: calls would read all
// of these.
inline void Seal(const pybind11::handle& type) {
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
