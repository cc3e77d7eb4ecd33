// SPDX-License-Identifier: Apache-2.0
// shading/light_sampling.h: directions to area lights and environments, their pdfs, and the
// radiance along a direction. Pdfs are per solid angle.
//
// What a hit reflects of such a light is estimated by the mean of (reflected radiance of a unit
// light in direction l) x radiance(l) / pdf(l) over directions sampled with that pdf, with
// shadow rays in between. Where two sampling strategies are combined by MIS with the balance
// heuristic (Veach and Guibas 1995), pdf(l) is the sum of the pdfs of both.
#pragma once

#include "hit/batch.h"
#include "sampling/pair_sampler.h"
#include "shading/light_directions.h"
#include "shading/sampled_light.h"
#include "shading/shade.h"

namespace nacre {

// Samples a direction to the light from each hit. Where a hit cannot see the light, the distance is
// 0.
void SampleLight(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                 LightDirections* directions);

// Fills in all of `directions` but to_light, which is given.
void FindLight(const SampledLight& light, const HitBatch& hits, LightDirections* directions);

// Computes in double where shadow rays along the directions meet the light, as multiples of the
// directions. `t_max` is changed only where it is positive and finite: there it holds the distance
// of LightDirections, whose relative error is some 2^-24. `directions` must be those of the last
// SampleLight or FindLight from these hits.
//
// For a flat light the end is offset.n / direction.n: rounding moves it no further from the light's
// plane than 10 2^-53 of the coordinates, at any angle.
void FindEnds(const SampledLight& light, const HitBatch& hits, const LightDirections& directions,
              AlignedArray<double>* t_max);

// The exact irradiance of the unoccluded light at each hit, per unit of its colour. If
// IsColored(light), `irradiance` gets three channels, else one, in x.
void LightIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     Soa3<float>* irradiance);

// The radiance of a sky that IsColored along directions, which need not be unit vectors.
void SkyRadiance(const SampledLight& light, const Soa3<double>& directions, size_t count,
                 Soa3<float>* radiance);

}  // namespace nacre
