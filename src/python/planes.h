// SPDX-License-Identifier: Apache-2.0
// python/planes.h: arrays of vectors that the package and the module exchange.
#pragma once

#include <cstddef>
#include <string>

#include <pybind11/numpy.h>

#include "python/guard.h"

namespace nacre_python {

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

}  // namespace nacre_python
