// SPDX-License-Identifier: Apache-2.0
// shading/shade.h: evaluates models and their layers, without coats, for batches of hits. bsdf.h
// evaluates whole materials.
//
//   PrepareRun       once per run of hits that share a material: terms that do not need the light
//   EvaluateLight    direction and irradiance of a light at every hit (unshadowed)
//   ShadeRun         per run: the radiance that the hits reflect of that light
// Between the last two, the renderer removes the light from hits that lie in shadow. A light
// without shadow rays for which EvaluatedInPlace is true needs no EvaluateLight: ShadeRun evaluates
// it itself, with the same bits.
// Each of these makes a few calls of Highway kernels (2.4 ns of dispatch each), so they take
// batches, never packets.
#pragma once

#include "shading/material_hits.h"

namespace nacre {

// Computes terms that do not depend on the light. Hits [begin, end) must all be of `material`,
// whose maps must have been looked up (textures.h).
void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitParameters* textures = nullptr);

// Stores what the hits reflect of the light, without coats. If the material has layers, lit.on_hits
// must not be null.
void ShadeRun(const LitHits& lit, ShadeScratch* scratch);

}  // namespace nacre
