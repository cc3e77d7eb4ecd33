// SPDX-License-Identifier: Apache-2.0
// shading/fast_area.h: what area lights have in their fast mode, in the place of samples of GGX
// lobes: linearly transformed cosines (light/ltc.h) for the lobe's shape, times what it reflects in
// all.
#pragma once

#include "shading/fast_sky.h"

namespace nacre {

// Whether the light, of which nothing hides anything, has the lobe of the material in its fast
// mode: a rectangle or a mesh, and a GGX lobe of one width on normals that no map turns.
bool HasTransformedLobe(const SampledLight& light, const ShadingMaterial& material);

// The part of the lobe that the light fills, on hits [begin, end).
void TransformedShare(const SampledLight& light, const ShadingMaterial& material,
                      const LobeRange& range, float* share);

// How far shares times reflectances are from samples, around the light, at distances of its size
// and more, where its highlights are: as parts of the mean of the samples' estimates.
FastLobeError MeasureTransformedLobe(const ShadingMaterial& material, const SampledLight& light,
                                     int threads);

}  // namespace nacre
