// SPDX-License-Identifier: Apache-2.0
// shading/area_kernels.h: the SIMD kernels behind sampled_light.h, for area lights, meshes
// and skies.
#pragma once

#include "shading/sampled_light.h"

namespace nacre {

// As SampleLight, FindLight and LightIrradiance, of lights that are neither skies nor meshes.
void SampleArea(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions);
void FindArea(const SampledLight& light, const HitBatch& hits, LightDirections* directions);
void AreaIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance);

void AreaEnds(const SampledLight& light, const HitBatch& hits, const LightDirections& directions,
              AlignedArray<double>* t_max);

// The same of meshes.
void SampleMesh(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions);
void FindMesh(const SampledLight& light, const HitBatch& hits, LightDirections* directions);
void MeshIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance);
void MeshEnds(size_t count, const LightDirections& directions, AlignedArray<double>* t_max);

// The same of pictures: fills in to_light, radiance and pdf.
void SampleSky(const SampledLight& light, const UnitPoints& points, size_t count,
               LightDirections* directions);

// Unit vectors along directions.
void NormalizeDirections(const Soa3<double>& directions, size_t count, Soa3<float>* unit);

// The radiance of a sky that has colours, along unit vectors, as multiples of its own; of pictures
// also the pdf with which SampleSky chooses them, unless null. `radiance` may be `directions`.
void EvaluateSky(const SampledLight& light, const Soa3<float>& directions, size_t count,
                 Soa3<float>* radiance, float* pdf);
// A sky's irradiance, but of pictures.
void SkyIrradiance(const SampledLight& light, const Surface& surface, size_t count,
                   Soa3<float>* irradiance);

}  // namespace nacre
