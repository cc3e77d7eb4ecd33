// SPDX-License-Identifier: Apache-2.0
// shading/mapped.h: light products for hits whose constants vary by maps, and terms of lobes that
// are too sharp for float.
#pragma once

#include "shading/hit_parameters.h"
#include "shading/kernels.h"
#include "shading/material.h"

namespace nacre {

// Fills HitParameters::products with the MatteLight, PhongLight or MicrofacetLight of hits
// [begin, end), computed in double and rounded once, as for materials without maps.
struct MappedProducts {
  const ShadingMaterial& material;
  Rgb color;
  size_t begin, end;
};
void MakeProducts(const MappedProducts& products, HitParameters* textures);

// Computes SharpLobeTerms under the light of a range in `terms`, and returns it, or null if no hit
// has a sharp lobe. `maps` is null unless hits have a lobe width each.
const SharpLobeTerms* FormSharpTerms(const PhongFamilyModel& model, const ShadeRange& range,
                                     const HitParameters* maps, SharpLobeTerms* terms);
const SharpLobeTerms* FormSharpTerms(const MicrofacetModel& model, const ShadeRange& range,
                                     const HitParameters* maps, SharpLobeTerms* terms);

}  // namespace nacre
