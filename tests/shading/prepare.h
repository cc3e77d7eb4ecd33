// SPDX-License-Identifier: Apache-2.0
// tests/shading/prepare.h: materials as the kernels want them.
#pragma once

#include "scene/material.h"
#include "shading/material.h"

namespace nacre {

inline ShadingMaterial Prepare(const Material& material) { return PrepareMaterial(material); }

template <class Model>
ShadingMaterial Prepare(const Model& model) {
  return Prepare(Material{.model = model});
}

}  // namespace nacre
