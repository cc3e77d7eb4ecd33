// shading/shade.h: from a batch of hits and the scene's lights to radiance towards the viewer.
//
//   PrepareRun       once per run of hits that share a material: what depends on the view alone
//   EvaluateLight    per light: direction and irradiance at every hit (unshadowed)
//   ShadeRun         per light and run: adds the reflected radiance
// Between the last two the renderer removes the light from the hits that lie in shadow.
// Each is one call of a Highway kernel (2.4 ns of dispatch), so batches, never packets.
#pragma once

#include "hit/batch.h"
#include "scene/scene.h"
#include "shading/material.h"

namespace nacre {

// The hits of a batch as seen by their viewer.
struct Surface : HitDirections {
  // Of hits on microfacet materials, by PrepareRun:
  AlignedArray<float> multiple{kBatchCapacity};  // the weight of multiple scattering
  Soa3<float> base;                              // the share of light that the diffuse base gets
};

// One light as the hits of a batch see it.
struct LightBatch {
  // From the hit to the light, in world units and not normalised; the unit direction to a light
  // that is infinitely far.
  Soa3<double> offset;
  double t_max = 1;      // a shadow ray along `offset` ends here: 1, or infinity
  Soa3<float> to_light;  // unit
  // Irradiance perpendicular to the light per unit of its colour: fall-off, cone and visibility.
  // 0 where the surface faces away (n.l <= 0): no model here reflects such light.
  AlignedArray<float> irradiance{kBatchCapacity};
};

// What a batch reflects so far, per hit.
struct ReflectedRadiance {
  Soa3<float> diffuse, specular;
};

// Room for the terms of lobes that are formed in double.
struct NarrowLobes {
  AlignedArray<float> first{kBatchCapacity}, second{kBatchCapacity};
};

// A batch under one light.
struct LitHits {
  const HitBatch& hits;
  const Surface& surface;
  const LightBatch& light;
};

// Rounds hits whose directions were given in double.
void PrepareSurface(const HitBatch& hits, Surface* surface);

// Hits [begin, end) are all of `material`.
void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface);

// `light` is not ambient. `camera_position` is what the hits' positions are relative to.
void EvaluateLight(const Light& light, const Vec3d& camera_position, const HitBatch& hits,
                   const Surface& surface, LightBatch* result);

// The light's colour: irradiance of a directional light, intensity of the others.
Rgb LightColor(const Light& light);

// Adds to `radiance` what hits [begin, end), all of `material`, reflect of the light.
void ShadeRun(const ShadingMaterial& material, const Rgb& light_color, const LitHits& lit,
              size_t begin, size_t end, NarrowLobes* scratch, ReflectedRadiance* radiance);

// Zeroes the first `count` entries.
void ClearSoa(size_t count, Soa3<float>* soa);
void ClearRadiance(size_t count, ReflectedRadiance* radiance);

}  // namespace nacre
