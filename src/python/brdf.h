// SPDX-License-Identifier: Apache-2.0
// python/brdf.h: the Python bindings of reflection models, which work on arrays.
#pragma once

#include <pybind11/pybind11.h>

namespace nacre_python {

void BindBrdfs(pybind11::module_* module);

}  // namespace nacre_python
