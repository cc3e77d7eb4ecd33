// SPDX-License-Identifier: Apache-2.0
// python/scene.h: the Python bindings of scenes, sessions and renders.
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

// Parameters by name, each with its value as JSON text.
using Members = std::vector<std::pair<std::string, std::string>>;
nacre::Parameters ParametersOf(const Members& members);

void BindScenes(pybind11::module_* module);

}  // namespace nacre_python
