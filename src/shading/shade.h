// SPDX-License-Identifier: Apache-2.0
// shading/shade.h: from a batch of hits and the scene's lights to radiance towards the viewer.
//
//   PrepareRun       once per run of hits that share a material: what depends on the view alone
//   EvaluateLight    direction and irradiance of a light at every hit (unshadowed)
//   ShadeRun         per run: adds the radiance that one or several lights leave
// Between the last two the renderer removes the light from the hits that lie in shadow. A light
// without shadow rays, of the forms that EvaluatedInPlace names, needs no EvaluateLight: ShadeRun
// does the same arithmetic on the way, with the same bits.
// Each is one call of a Highway kernel (2.4 ns of dispatch), so batches, never packets.
#pragma once

#include <memory>
#include <span>

#include "hit/batch.h"
#include "shading/light.h"
#include "shading/material.h"

namespace nacre {

// The hits of a batch as seen by their viewer.
struct Surface : HitDirections {
  // Maps have turned the normals of some hits; the surface's own, of all, are then in `unturned`.
  bool turned = false;
  Soa3<float> unturned;
  // Of hits on microfacet materials, by PrepareRun:
  AlignedArray<float> multiple{kBatchCapacity};  // the weight of multiple scattering
  Soa3<float> base;                              // the share of light that the diffuse base gets
};

// One light as the hits of a batch see it.
struct LightBatch {
  // Of LightForm::kGiven: unit vectors. After EvaluateLight: of any length, to be multiplied by
  // inverse_length.
  Soa3<float> to_light;
  AlignedArray<float> inverse_length{kBatchCapacity};
  // Irradiance perpendicular to the light per unit of its colour: fall-off, cone and visibility.
  // 0 where the surface faces away (n.l <= 0): no model here reflects such light.
  AlignedArray<float> irradiance{kBatchCapacity};
};

// A light to shade by.
struct LightOnBatch {
  const ShadingLight* light;
  const LightBatch* evaluated;  // null: ShadeRun is to evaluate it in place
};

// What a batch reflects so far, per hit: its parts, or their sum, or both.
struct ReflectedRadiance {
  Soa3<float> diffuse, specular;
  Soa3<float> sum;
};

// What ShadeRun leaves in it.
enum class Leaves : uint8_t {
  kAddedParts,  // the parts, added to those that are there
  kParts,       // the parts; those that are there count as 0, whatever they are
  // Of one light. The specular part is rounded once, as it is added: within an ulp of the parts'
  // own sum.
  kSum,
  kPartsAndSum,  // the bits of both
};

// How rough bases spread a light: what their Lambertian reflection is multiplied by, single + ratio
// multiple.
struct BaseSpread {
  AlignedArray<float> single{kBatchCapacity}, multiple{kBatchCapacity};
};

// What is below a layer of fuzz, under a light.
struct BelowSheen {
  LightBatch light;
  ReflectedRadiance radiance;
};

// Room for the terms of lobes that are formed in double, and for what bases make of a light.
struct NarrowLobes {
  AlignedArray<float> first{kBatchCapacity}, second{kBatchCapacity};
  BaseSpread base;
  std::unique_ptr<BelowSheen> below_sheen;  // made for the first hit that has any
};

struct HitTextures;

// A batch under lights, whose reflections are added in this order.
struct LitHits {
  const HitBatch& hits;
  const Surface& surface;
  std::span<const LightOnBatch> lights;
  HitTextures* textures = nullptr;  // of materials with maps
  Leaves leaves = Leaves::kAddedParts;
};

// Rounds hits whose directions were given in double.
void PrepareSurface(const HitBatch& hits, Surface* surface);

// Hits [begin, end) are all of `material`.
// Those of materials with maps have been looked up (textures.h).
void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitTextures* textures = nullptr);

// True for directional lights and point lights that fall off with the square of the distance.
bool EvaluatedInPlace(const ShadingLight& light);

// `light` is not LightForm::kGiven.
void EvaluateLight(const ShadingLight& light, const HitBatch& hits, const Surface& surface,
                   LightBatch* result);

// Brings to `radiance` what hits [begin, end), all of `material`, reflect of the lights.
void ShadeRun(const ShadingMaterial& material, const LitHits& lit, size_t begin, size_t end,
              NarrowLobes* scratch, ReflectedRadiance* radiance);

// Zeroes the first `count` entries.
void ClearSoa(size_t count, Soa3<float>* soa);
void ClearRadiance(size_t count, ReflectedRadiance* radiance);

}  // namespace nacre
