// SPDX-License-Identifier: Apache-2.0
// render/sampled_kernel.h: the SIMD loops of sampled_lights.cc, over the hits of a batch. Sums and
// products stay apart, so every target gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "shading/sampled_light.h"

namespace nacre {

// Lets a unit light shine on the hits that face it along the directions and do not miss it. Returns
// how many directions are not finite: they bring no light, and no ray follows them.
size_t ShineAlong(const LightDirections& directions, const Surface& surface, size_t count,
                  LightBatch* light);

// The pdf of the directions in the ways that the diffuse part is sampled by: SampleLight's,
// SampleCosine's or the sum. 0 at hits with flat[i] != 0, whose diffuse part is in closed form;
// `flat` may be null.
struct DiffuseWays {
  bool light, cosine;
};
void FindDiffusePdf(const DiffuseWays& ways, const LightDirections& directions,
                    const Surface& surface, const uint8_t* flat, size_t count, float* pdf);

// Aims shadow rays along the directions. Those of lit hits end at the light, and the others where
// they start.
void AimShadowRays(const LightDirections& directions, const float* irradiance, size_t count,
                   ShadowRayBatch* rays);

// weight = 1 / pdf; 0 where no light comes from, or no direction is chosen.
void FindWeights(const float* irradiance, const float* pdf, size_t count, float* weight);

// sum += part x weight x color, and x radiance unless that is null.
void AddWeighted(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                 const Rgb& color, size_t count, Soa3<float>* sum);

}  // namespace nacre
