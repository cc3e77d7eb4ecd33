// SPDX-License-Identifier: Apache-2.0
#include "shading/light_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shading/area_kernels.h"

namespace nacre {

void SampleLight(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                 LightDirections* directions) {
  if (light.form == SampledForm::kMesh) return SampleMesh(light, hits, points, directions);
  if (!IsSky(light)) return SampleArea(light, hits, points, directions);
  SampleSky(light, points, hits.count, directions);
  std::fill_n(directions->distance.data(), hits.count, std::numeric_limits<float>::infinity());
}

void FindLight(const SampledLight& light, const HitBatch& hits, LightDirections* directions) {
  if (light.form == SampledForm::kMesh) return FindMesh(light, hits, directions);
  if (!IsSky(light)) return FindArea(light, hits, directions);
  std::fill_n(directions->distance.data(), hits.count, std::numeric_limits<float>::infinity());
  std::fill_n(directions->pdf.data(), hits.count, 0.0f);
  if (IsColored(light)) {
    EvaluateSky(light, directions->to_light, hits.count, &directions->radiance,
                directions->pdf.data());
  }
}

void FindEnds(const SampledLight& light, const HitBatch& hits, const LightDirections& directions,
              AlignedArray<double>* t_max) {
  if (light.form == SampledForm::kMesh) return MeshEnds(hits.count, directions, t_max);
  if (!IsSky(light)) AreaEnds(light, hits, directions, t_max);
}

void LightIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     Soa3<float>* irradiance) {
  if (light.form == SampledForm::kMesh) {
    return MeshIrradiance(light, hits, surface, irradiance->x.data());
  }
  if (!IsSky(light)) return AreaIrradiance(light, hits, surface, irradiance->x.data());
  if (IsColored(light)) return SkyIrradiance(light, surface, hits.count, irradiance);
  std::fill_n(irradiance->x.data(), hits.count, static_cast<float>(M_PI));
}

void SkyRadiance(const SampledLight& light, const Soa3<double>& directions, size_t count,
                 Soa3<float>* radiance) {
  NormalizeDirections(directions, count, radiance);
  EvaluateSky(light, *radiance, count, radiance, nullptr);
  const Vec3f color(light.color);
  for (int c = 0; c < 3; ++c) {
    float* const channel = ChannelOf(*radiance, c).data();
    for (size_t i = 0; i < count; ++i) channel[i] *= color[c];
  }
}

}  // namespace nacre
