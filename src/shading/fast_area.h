// SPDX-License-Identifier: Apache-2.0
// shading/fast_area.h: what area lights have in their fast mode, in the place of samples of GGX
// lobes: linearly transformed cosines (light/ltc.h) for the lobe's shape, times what it reflects in
// all.
#pragma once

#include "shading/fast_sky.h"

namespace nacre {

// Whether the light, of which nothing hides anything, has the lobe of the material in its fast
// mode: a sphere, a flat light or a mesh with a closed form, and a GGX lobe of one width on normals
// that no map turns.
bool HasTransformedLobe(const SampledLight& light, const ShadingMaterial& material);

// Buffers: the parts of a lobe that a light fills, for F = 1 and for what Fresnel's curve adds to
// its value at normal incidence; and how much is added.
struct LobeShares {
  AlignedArray<float> one{kBatchCapacity}, schlick{kBatchCapacity};
  Soa3<float> grazing;
};

// What the lobe reflects of a light of colour 1, on hits [begin, end).
void TransformedReflectance(const SampledLight& light, const ShadingMaterial& material,
                            const LobeRange& range, LobeShares* shares, Soa3<float>* reflected);

// How far shares times reflectances are from samples, around the light, at distances of its size
// and more, where its highlights are: as parts of the mean of the samples' estimates.
FastLobeError MeasureTransformedLobe(const ShadingMaterial& material, const SampledLight& light,
                                     int threads);

}  // namespace nacre
