// SPDX-License-Identifier: Apache-2.0
// shading/mapped.h: what shading takes of hits that maps give a model of their own, and of lobes
// that are too sharp for float.
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

// SharpLobeTerms under the first light of a range, in `terms`; null if no hit has a sharp lobe.
// `maps`: of hits with a width each; or null.
const SharpLobeTerms* FormSharpTerms(const PhongFamilyModel& model, const ShadeRange& range,
                                     const HitTextures* maps, SharpLobeTerms* terms);
const SharpLobeTerms* FormSharpTerms(const MicrofacetModel& model, const ShadeRange& range,
                                     const HitTextures* maps, SharpLobeTerms* terms);

}  // namespace nacre
