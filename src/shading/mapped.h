// SPDX-License-Identifier: Apache-2.0
// shading/mapped.h: what shading takes of hits that maps give a model of their own.
#pragma once

#include "shading/kernels.h"
#include "shading/textures.h"

namespace nacre {

// Fills HitTextures::products with the MatteLight, PhongLight or MicrofacetLight of hits
// [begin, end), in double and rounded once, as those of other materials are.
struct MappedProducts {
  const ShadingMaterial& material;
  Rgb color;
  size_t begin, end;
};
void MakeProducts(const MappedProducts& products, HitTextures* textures);

// The terms of narrow lobes under the first light of a range, in `scratch`; null if no hit has one.
// `maps`: of hits with a width each; or null.
const NarrowLobes* NarrowTerms(const PhongFamilyModel& model, const ShadeRange& range,
                               const HitTextures* maps, NarrowLobes* scratch);
const NarrowLobes* NarrowTerms(const MicrofacetModel& model, const ShadeRange& range,
                               const HitTextures* maps, NarrowLobes* scratch);

}  // namespace nacre
