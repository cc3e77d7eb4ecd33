// shading/shade.h: from a batch of hits and the scene's lights to radiance towards the viewer.
//
//   PrepareSurface   once per batch: the hits' directions in float
//   EvaluateLight    per light: direction and irradiance at every hit (unshadowed)
//   ShadeRun         per light and per run of hits that share a material: adds the reflected
//                    radiance
// Between the last two the renderer removes the light from the hits that lie in shadow.
// Each is one call of a Highway kernel (2.4 ns of dispatch), so batches, never packets.
#pragma once

#include "hit/batch.h"
#include "scene/scene.h"

namespace nacre {

// The directions of a HitBatch, rounded to float.
struct Surface {
  Soa3<float> normal, to_view;
};

// One light as the hits of a batch see it.
struct LightBatch {
  Soa3<float> to_light;  // unit
  // Irradiance perpendicular to the light per unit of its colour: fall-off, cone and visibility.
  // 0 where the surface faces away (n.l <= 0): no model here reflects such light.
  AlignedArray<float> irradiance{kBatchCapacity};
};

// What a batch reflects so far, per hit.
struct ReflectedRadiance {
  Soa3<float> diffuse, specular;
};

void PrepareSurface(const HitBatch& hits, Surface* surface);

// `light` is not ambient. `camera_position` is what the hits' positions are relative to.
void EvaluateLight(const Light& light, const Vec3d& camera_position, const HitBatch& hits,
                   const Surface& surface, LightBatch* result);

// The light's colour: irradiance of a directional light, intensity of the others.
Rgb LightColor(const Light& light);

// Adds to `radiance` what hits [begin, end), all of `material`, reflect of the light. `material`
// is not a split.
void ShadeRun(const Material& material, const Rgb& light_color, const Surface& surface,
              const LightBatch& light, size_t begin, size_t end, ReflectedRadiance* radiance);

// Zeroes the first `count` entries.
void ClearSoa(size_t count, Soa3<float>* soa);
void ClearRadiance(size_t count, ReflectedRadiance* radiance);

// What a material shows whatever the direction.
struct MaterialConstants {
  Rgb ambient;  // radiance reflected of `ambient_radiance`
  Rgb emission;
  Rgb albedo;  // for the albedo layer: diffuse reflectance, or base colour
};
MaterialConstants ComputeMaterialConstants(const Material& material, const Rgb& ambient_radiance);

}  // namespace nacre
