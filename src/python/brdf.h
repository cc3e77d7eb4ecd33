// SPDX-License-Identifier: Apache-2.0
// python/brdf.h: reflection models over arrays, and Python functions as reflection models.
#pragma once

#include <pybind11/pybind11.h>

#include "nacre.h"

namespace nacre_python {

// Of the functions of a nacre.Brdf: evaluate(normal, to_view, to_light), and perhaps
// sample(normal, to_view, u) and pdf(normal, to_view, to_light), which take arrays of shape
// (count, 3) or (count, 2) and return such of shape (3, count) or (count,), all float64.
nacre::UserBrdf UserBrdfOf(const pybind11::object& evaluate, const pybind11::object& sample,
                           const pybind11::object& pdf);

void BindBrdfs(pybind11::module_* module);

}  // namespace nacre_python
