// SPDX-License-Identifier: Apache-2.0
// shading/mapped.h: shading of materials whose maps give each hit a model of its own.
#pragma once

#include "shading/kernels.h"
#include "shading/textures.h"

namespace nacre {

// Whether maps give each hit its own reflection; a map of emission, or of normals, does not.
bool HasMappedModel(const ShadingMaterial& material);

// Whether hits have a roughness each.
bool HasOwnFits(const ShadingMaterial& material);

// As ShadeRun, from what FinishMaterial left in `textures`; one light after the other.
void ShadeMapped(const ShadingMaterial& material, const ShadeRange& range, NarrowLobes* scratch,
                 HitTextures* textures);

// Products of a light with what each hit reflects, in double and rounded once, as uniforms are.
struct MappedProducts {
  const ShadingMaterial& material;
  Rgb color;
  size_t begin, end;
};
void MakeProducts(const MappedProducts& products, HitTextures* textures);

}  // namespace nacre
