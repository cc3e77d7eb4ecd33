// SPDX-License-Identifier: Apache-2.0
// tests/shading/prepare.h: materials as the kernels want them.
#pragma once

#include "shading/material.h"

namespace nacre {

// Under no ambient light unless it is told.
inline ShadingMaterial Prepare(const Material& material, const Rgb& sky = {0, 0, 0}) {
  return PrepareMaterial(material, sky);
}

template <class Model>
ShadingMaterial Prepare(const Model& model, const Rgb& sky = {0, 0, 0}) {
  Material material;
  material.model = model;
  return Prepare(material, sky);
}

}  // namespace nacre
