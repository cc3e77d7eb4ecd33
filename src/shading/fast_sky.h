// SPDX-License-Identifier: Apache-2.0
// shading/fast_sky.h: what a sky has in its fast mode, in the place of samples: harmonics of a
// picture's irradiance, and the split sum (Karis 2013, "Real Shading in Unreal Engine 4") for
// lobes: what a lobe sees on average, times what it reflects in all.
#pragma once

#include <span>
#include <vector>

#include "light/harmonics.h"
#include "light/prefilter.h"
#include "shading/lobe_sample.h"
#include "shading/sampled_light.h"

namespace nacre {

struct FastSky {
  IrradianceHarmonics<float> harmonics;  // of a picture
  std::vector<PrefilteredMap> lobes;     // of widths that materials have; of a constant sky none
};

// Whether a sky may be prefiltered for the material's lobe: a GGX lobe of one width that is not
// narrow, on normals that no map turns.
bool HasFastLobe(const ShadingMaterial& material);

// Whether the light's fast mode has the material's lobe.
bool HasFastLobe(const SampledLight& light, const ShadingMaterial& material);

// The sky as lobes of that width see it; null if they are to be sampled.
const PrefilteredMap* FindLobe(const FastSky& sky, double alpha);

// The light, a sky with colours, as an image, for Prefilter: a picture's own, in which directions
// are turned back.
std::shared_ptr<const EnvironmentMap> ImageOf(const SampledLight& light);

// The split sum's halves: what a lobe that has a fast mode reflects in all, per channel, on hits
// [begin, end); and what it sees in the mirror's direction, as a multiple of the light's colour.
// `grazing`, unless null: the part of that which Fresnel's curve adds to its value at normal
// incidence.
void FastReflectance(const ShadingMaterial& material, const LobeRange& range,
                     Soa3<float>* reflectance, Soa3<float>* grazing = nullptr);
void FastRadiance(const SampledLight& light, const ShadingMaterial& material, size_t begin,
                  size_t end, const Soa3<float>& mirrored, Soa3<float>* radiance);

// How far the split sum is from samples, at normals all round and three views of each, as parts of
// the mean of the samples' estimates: a channel each, and together.
struct FastLobeError {
  size_t points = 0;
  double rms = 0, worst = 0;
};
FastLobeError CompareEstimates(std::span<const Vec3d> truth, std::span<const Vec3d> fast);
FastLobeError MeasureFastLobe(const ShadingMaterial& material, const SampledLight& light,
                              int threads);

}  // namespace nacre
