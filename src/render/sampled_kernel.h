// SPDX-License-Identifier: Apache-2.0
// render/sampled_kernel.h: the SIMD loops of sampled_lights.cc over the hits of a batch. Products
// and sums are never fused, so that every target gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "shading/light_sampling.h"

namespace nacre {

// Sets `light` to a light of irradiance 1 from the sampled directions, and 0 where the direction
// misses the light or is below the horizon (LowestHeight). Returns how many directions are not
// finite: they have irradiance 0, and no shadow ray follows them.
size_t IlluminateAlong(const LightDirections& directions, const Surface& surface, size_t count,
                       LightBatch* light);

// Sets the directions and ends of shadow rays. Rays of lit hits end at the light; the others are
// inactive.
void AimShadowRays(const LightDirections& directions, const float* irradiance, size_t count,
                   ShadowRayBatch* rays);

// The sum of two pdfs, each of which may be null.
void AddPdfs(const float* a, const float* b, size_t count, float* sum);

// weight = 1 / pdf; 0 where the irradiance or the pdf is 0.
void ComputeWeights(const float* irradiance, const float* pdf, size_t count, float* weight);

// sum += part * weight * color, also times `radiance` unless that is null.
void AddWeighted(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                 const Rgb& color, size_t count, Soa3<float>* sum);

}  // namespace nacre
