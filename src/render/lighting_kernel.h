// SPDX-License-Identifier: Apache-2.0
// render/lighting_kernel.h: the SIMD loops of the direct integrator over the hits of a batch.
// Products and sums are never fused, so that every target gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hit/batch.h"
#include "shading/light.h"
#include "shading/light_sampling.h"

namespace nacre {

// Makes rays [0, rays->count): ray r starts from hit from[r], at origin[from[r]], and goes to the
// light. Entries after them, up to a whole vector, are overwritten.
void FillShadowRays(const ShadingLight& light, const HitBatch& hits, const Soa3<double>& origin,
                    const AlignedArray<uint32_t>& from, ShadowRayBatch* rays);

// Sets `light` to a light of irradiance 1 from the sampled directions, and 0 where the direction
// misses the light or is below the horizon (LowestHeight). Returns how many directions are not
// finite: they have irradiance 0, and no shadow ray follows them.
size_t IlluminateAlong(const LightDirections& directions, const Surface& surface, size_t count,
                       LightBatch* light);

// Sets the directions and ends of shadow rays. Rays of lit hits end at the light; the others are
// inactive.
void AimShadowRays(const LightDirections& directions, const float* irradiance, size_t count,
                   ShadowRayBatch* rays);

// weight = 1 / (a + b), where a and b are pdfs, each of which may be null; 0 where the irradiance
// or the sum is 0.
void ComputeWeights(const float* irradiance, const float* a, const float* b, size_t count,
                    float* weight);

// sum += part * weight * color, also times `radiance` unless that is null.
void AddWeighted(const Soa3<float>& part, const float* weight, const Soa3<float>* radiance,
                 const Rgb& color, size_t count, Soa3<float>* sum);

}  // namespace nacre
