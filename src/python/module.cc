// SPDX-License-Identifier: Apache-2.0
// python/module.cc: the extension module _nacre, on which the package nacre is built. It is not an
// interface for users.
#include "python/module.h"

#include <utility>

#include <pybind11/stl.h>
#include <unistd.h>

namespace nacre_python {
namespace {

void Throw(const char* name, const py::tuple& arguments) {
  const py::object type = py::module_::import("nacre._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(*arguments).ptr());
}

void Translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const nacre::Error& error) {
    py::list faults;
    for (const nacre::Fault& fault : error.faults()) {
      faults.append(py::make_tuple(TextOf(fault.where), TextOf(fault.what), TextOf(fault.hint)));
    }
    Throw("Error", py::make_tuple(TextOf(error.what()), faults, error.exit_code()));
  } catch (const py::cast_error&) {
    PyErr_SetString(PyExc_TypeError, "nacre: an argument is of the wrong type");
  } catch (const nacre::Cancelled&) {
    Throw("Cancelled", py::make_tuple("the render was cancelled"));
  }
}

}  // namespace
}  // namespace nacre_python

PYBIND11_MODULE(_nacre, module) {
  using namespace nacre_python;
  py::register_exception_translator(&Translate);
  module.def("version", &nacre::Version);
  module.def("supported_targets", &nacre::SupportedTargets);
  module.def("active_target", &nacre::ActiveTarget);
  module.def("set_target", &nacre::SetTarget);
  module.def("scene_schema", &nacre::SceneSchema);
  // Older versions of pybind11 refuse other interpreters themselves.
  module.def("is_main_interpreter",
             [] { return PyInterpreterState_Get() == PyInterpreterState_Main(); });
  module.def("stop_all", &Running::StopAll);
  module.def("after_fork", [process = getpid()]() mutable {
    if (std::exchange(process, getpid()) == getpid()) return;  // renders may be running here
    FunctionLock::Reset();
    Running::Reset();
  });
  BindImages(&module);
  BindScenes(&module);
  BindBrdfs(&module);
  BindTables(&module);
}
