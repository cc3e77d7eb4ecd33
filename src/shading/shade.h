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

#include "hit/batch.h"
#include "shading/light.h"
#include "shading/material.h"
#include "shading/surface.h"

namespace nacre {

struct HitParameters;

// The hits of a batch under one light.
struct LitHits {
  const HitBatch& hits;
  const Surface& surface;
  const ShadingLight& light;
  const LightBatch* on_hits;          // the light at the hits; may be null if EvaluatedInPlace
  bool components = true;             // whether diffuse and specular radiance are stored, too
  HitParameters* textures = nullptr;  // for materials with maps
};

// Computes terms that do not depend on the light. Hits [begin, end) must all be of `material`,
// whose maps must have been looked up (textures.h).
void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitParameters* textures = nullptr);

// Stores in `radiance` what hits [begin, end), all of `material`, reflect of the light. If the
// material has layers, lit.on_hits must not be null.
void ShadeRun(const ShadingMaterial& material, const LitHits& lit, size_t begin, size_t end,
              ShadeScratch* scratch, ReflectedRadiance* radiance);

}  // namespace nacre
