// SPDX-License-Identifier: Apache-2.0
// render/sampled_kernel.h: the SIMD loops of sampled_lights.cc over the hits of a batch. Products
// and sums are never fused, so that every target gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "shading/light_sampling.h"

namespace nacre {

// Sets `light` to a light of irradiance 1 from the sampled directions, and 0 where the direction
// misses the light or the hit faces away from it. Returns how many directions are not finite: they
// have irradiance 0, and no shadow ray follows them.
size_t IlluminateAlong(const LightDirections& directions, const Surface& surface, size_t count,
                       LightBatch* light);

// The strategies that sample diffuse reflection: SampleLight, SampleCosine, or both.
struct DiffuseStrategies {
  bool light, cosine;
};
// The sum of the pdfs of these strategies along the directions. 0 at hits with closed_form[i] != 0,
// whose diffuse reflection is computed in closed form; `closed_form` may be null.
void ComputeDiffusePdf(const DiffuseStrategies& strategies, const LightDirections& directions,
                       const Surface& surface, const uint8_t* closed_form, size_t count,
                       float* pdf);

// Sets the directions and ends of shadow rays. Rays of lit hits end at the light; the others are
// inactive.
void AimShadowRays(const LightDirections& directions, const float* irradiance, size_t count,
                   ShadowRayBatch* rays);

// weight = 1 / pdf; 0 where the irradiance or the pdf is 0.
void ComputeWeights(const float* irradiance, const float* pdf, size_t count, float* weight);

// sum += part * weight * color, also times `radiance` unless that is null.
void AddWeighted(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                 const Rgb& color, size_t count, Soa3<float>* sum);

}  // namespace nacre
