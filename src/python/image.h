// SPDX-License-Identifier: Apache-2.0
// python/image.h: converts images between Python, where all channels are one array, and the public
// API.
#pragma once

#include <pybind11/pybind11.h>

#include "nacre.h"

namespace nacre_python {

// To and from an object of Python's class nacre.Image.
pybind11::object ToPython(nacre::Image&& image);
nacre::Image FromPython(const pybind11::object& image);

void BindImages(pybind11::module_* module);

}  // namespace nacre_python
