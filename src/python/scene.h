// SPDX-License-Identifier: Apache-2.0
// python/scene.h: scenes, sessions and renders of the public API for Python.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include "nacre.h"
#include "python/guard.h"

namespace nacre_python {

struct Scene {
  nacre::Scene scene;
  mutable Users users;
};

// Parameters by name, each as JSON text.
using Members = std::vector<std::pair<std::string, std::string>>;
nacre::Parameters ParametersOf(const Members& members);

void BindScenes(pybind11::module_* module);

}  // namespace nacre_python
