// SPDX-License-Identifier: Apache-2.0
// python/sealed.h: classes whose objects C++ alone makes.
#pragma once

#include <pybind11/pybind11.h>

namespace nacre_python {

// To be called when a class has all of its functions. An object that `__new__` alone has made would
// hold nothing, one of a subclass perhaps something else, and one whose `__class__` was changed
// another class's memory: calls would read it all the same.
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
