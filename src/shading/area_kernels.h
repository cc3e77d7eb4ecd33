// SPDX-License-Identifier: Apache-2.0
// shading/area_kernels.h: the SIMD kernels behind light_sampling.h, for area lights, meshes
// and skies.
#pragma once

#include "sampling/pair_sampler.h"
#include "shading/light_directions.h"
#include "shading/sampled_light.h"
#include "shading/shade.h"

namespace nacre {

// SampleLight, FindLight, LightIrradiance and FindEnds (light_sampling.h) for lights that are
// neither skies nor meshes.
void SampleArea(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions);
void FindArea(const SampledLight& light, const HitBatch& hits, LightDirections* directions);
void AreaIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance);

void AreaEnds(const SampledLight& light, const HitBatch& hits, const LightDirections& directions,
              AlignedArray<double>* t_max);

// SampleLight, FindLight, LightIrradiance and FindEnds for mesh lights.
void SampleMesh(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions);
void FindMesh(const SampledLight& light, const HitBatch& hits, LightDirections* directions);
void MeshIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance);
void MeshEnds(size_t count, const LightDirections& directions, AlignedArray<double>* t_max);

// SampleLight for picture skies, without distances: fills in to_light, radiance and pdf.
void SampleSky(const SampledLight& light, const UnitPoints& points, size_t count,
               LightDirections* directions);

// Stores unit vectors along the directions.
void NormalizeDirections(const Soa3<double>& directions, size_t count, Soa3<float>* unit);

// Stores the radiance of a sky that IsColored along unit vectors, as multiples of
// SampledLight::color. For picture skies it also stores the pdf with which SampleSky chooses the
// directions, unless `pdf` is null. `radiance` may be `directions`.
void EvaluateSky(const SampledLight& light, const Soa3<float>& directions, size_t count,
                 Soa3<float>* radiance, float* pdf);
// Stores the irradiance of a gradient or quadratic sky.
void SkyIrradiance(const SampledLight& light, const Surface& surface, size_t count,
                   Soa3<float>* irradiance);

}  // namespace nacre
