// SPDX-License-Identifier: Apache-2.0
// python/user_brdf.cc: uses Python functions as reflection models.
#include <array>
#include <cstring>
#include <memory>
#include <optional>

#include "python/module.h"

namespace nacre_python {
namespace {

// A Python function that C++ threads may copy, destroy and, with the interpreter lock, call.
class Function {
 public:
  explicit Function(const py::object& function)
      : function_(new py::object(function), [](py::object* object) {
          const py::gil_scoped_acquire acquire;
          delete object;
        }) {}

  template <class... Arguments>
  py::object operator()(Arguments&&... arguments) const {
    return (*function_)(std::forward<Arguments>(arguments)...);
  }

 private:
  std::shared_ptr<py::object> function_;
};

#if PY_VERSION_HEX < 0x030D0000  // its public name since Python 3.13
int Py_IsFinalizing() { return _Py_IsFinalizing(); }
#endif

// Python keeps a state for each thread that calls it. This makes the state of a renderer's thread
// once and keeps it. With py::gil_scoped_acquire alone, each call would make a new one, which takes
// as long as the rest of the call.
class ThreadState {
 public:
  ThreadState() : state_(PyGILState_Ensure()), saved_(PyEval_SaveThread()) {}
  ~ThreadState() {
    if (!Py_IsInitialized() || Py_IsFinalizing() != 0) return;
    PyEval_RestoreThread(saved_);
    PyGILState_Release(state_);
  }
  ThreadState(const ThreadState&) = delete;
  ThreadState& operator=(const ThreadState&) = delete;

 private:
  PyGILState_STATE state_;
  PyThreadState* saved_;
};

// The locks that a render's thread holds while it calls a user's function.
class Call {
 public:
  Call() {
    static thread_local const ThreadState state;
    interpreter_.emplace();
  }

 private:
  FunctionLock function_;
  std::optional<py::gil_scoped_acquire> interpreter_;
};

// A copy, as the function may keep it: an array of shape (count, columns), with contiguous columns.
template <size_t kColumns>
py::object Columns(size_t count, const std::array<const double*, kColumns>& from) {
  py::array_t<double, py::array::f_style> columns({count, kColumns});
  for (size_t c = 0; c < kColumns; ++c) {
    std::memcpy(columns.mutable_data() + c * count, from[c], count * sizeof(double));
  }
  return columns;
}

void CopyPlanes(const py::object& result, size_t count, const std::array<double*, 3>& to) {
  const Planes planes = result;
  RequireShape(planes, 3, count);
  for (size_t c = 0; c < 3; ++c) {
    std::memcpy(to[c], planes.data() + c * count, count * sizeof(double));
  }
}

}  // namespace

nacre::UserBrdf UserBrdfOf(const py::object& evaluate, const py::object& sample,
                           const py::object& pdf) {
  nacre::UserBrdf brdf;
  brdf.evaluate = [function = Function(evaluate)](const nacre::Directions& d, const auto& rgb) {
    const Call call;
    CopyPlanes(function(Columns<3>(d.count, d.normal), Columns<3>(d.count, d.to_view),
                        Columns<3>(d.count, d.to_light)),
               d.count, rgb);
  };
  if (!sample.is_none()) {
    brdf.sample = [function = Function(sample)](const nacre::Directions& d, const double* u,
                                                const double* v, const auto& to_light) {
      const Call call;
      CopyPlanes(function(Columns<3>(d.count, d.normal), Columns<3>(d.count, d.to_view),
                          Columns<2>(d.count, {u, v})),
                 d.count, to_light);
    };
  }
  if (!pdf.is_none()) {
    brdf.pdf = [function = Function(pdf)](const nacre::Directions& d, double* out) {
      const Call call;
      const Planes values = function(Columns<3>(d.count, d.normal), Columns<3>(d.count, d.to_view),
                                     Columns<3>(d.count, d.to_light));
      if (static_cast<size_t>(values.size()) != d.count) {
        throw py::value_error("nacre: a pdf is not one number for each sample");
      }
      std::memcpy(out, values.data(), d.count * sizeof(double));
    };
  }
  return brdf;
}

}  // namespace nacre_python
