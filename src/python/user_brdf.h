// SPDX-License-Identifier: Apache-2.0
// python/user_brdf.h: uses Python functions as reflection models.
#pragma once

#include <pybind11/pybind11.h>

#include "nacre.h"

namespace nacre_python {

// Wraps the functions of a nacre.Brdf: evaluate(normal, to_view, to_light) and, unless they are
// None, sample(normal, to_view, u) and pdf(normal, to_view, to_light). They take arrays of shape
// (count, 3) or (count, 2) and return arrays of shape (3, count) or (count,), all float64.
nacre::UserBrdf UserBrdfOf(const pybind11::object& evaluate, const pybind11::object& sample,
                           const pybind11::object& pdf);

}  // namespace nacre_python
