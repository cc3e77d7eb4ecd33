// SPDX-License-Identifier: Apache-2.0
// shading/shade.h: from a batch of hits and the scene's lights to radiance towards the viewer.
//
//   PrepareRun       once per run of hits that share a material: what depends on the view alone
//   EvaluateLight    direction and irradiance of a light at every hit (unshadowed)
//   ShadeRun         per run: the radiance that the hits reflect of that light
// Between the last two the renderer removes the light from the hits that lie in shadow. A light
// without shadow rays, of the forms that EvaluatedInPlace names, needs no EvaluateLight: ShadeRun
// does the same arithmetic on the way, with the same bits.
// Each is a few calls of Highway kernels (2.4 ns of dispatch), so batches, never packets.
#pragma once

#include <memory>

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

// What the hits of a batch reflect: the sum, and its components, where they are asked for. In the
// sum the specular component is rounded once, as it is added.
struct ReflectedRadiance {
  Soa3<float> sum;
  Soa3<float> diffuse, specular;
};

// The half-vector terms of sharp lobes, formed in double (sharp_lobe_kernel.cc). Of hits with a
// roughness or exponent each, those whose lobe is wide have a distribution or one_minus_cos of -1.
struct SharpLobeTerms {
  AlignedArray<float> distribution{kBatchCapacity};                        // of GGX
  AlignedArray<float> one_minus_cos{kBatchCapacity}, cos{kBatchCapacity};  // of Phong's lobe
};

// How rough bases spread a light: what their Lambertian reflection is multiplied by, single + ratio
// multiple.
struct BaseSpread {
  AlignedArray<float> single{kBatchCapacity}, multiple{kBatchCapacity};
};

// The hits that a model of the caller's own is asked for, without gaps, and what it answers.
struct UserRoom {
  LightBatch light;
  Soa3<double> normal, to_view, to_light, value;
  AlignedArray<double> n_dot_l{kBatchCapacity}, u{kBatchCapacity}, v{kBatchCapacity};
  AlignedArray<uint32_t> hit{kBatchCapacity};
};

// What ShadeRun and LobePdf keep between the kernels of a run.
struct ShadeScratch {
  SharpLobeTerms sharp;
  BaseSpread base;
  std::unique_ptr<UserRoom> user;  // made for the first hit with a model of the caller's own
};

struct HitTextures;

// A batch under one light.
struct LitHits {
  const HitBatch& hits;
  const Surface& surface;
  const ShadingLight& light;
  const LightBatch* on_hits;        // the light, evaluated at the hits; null: EvaluatedInPlace
  bool components = true;           // they are asked for
  HitTextures* textures = nullptr;  // of materials with maps
};

// Rounds hits whose directions were given in double.
void PrepareSurface(const HitBatch& hits, Surface* surface);

// Hits [begin, end) are all of `material`, whose maps have been looked up (textures.h).
void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitTextures* textures = nullptr);

// True for directional lights, and for point lights far from all spheres that fall off with the
// square of the distance (ShadingLight::from_spheres).
bool EvaluatedInPlace(const ShadingLight& light);

// `light` is not LightForm::kGiven.
void EvaluateLight(const ShadingLight& light, const HitBatch& hits, const Surface& surface,
                   LightBatch* result);

// Writes to `radiance` what hits [begin, end), all of `material`, reflect of the light, which has
// been evaluated if there are layers.
void ShadeRun(const ShadingMaterial& material, const LitHits& lit, size_t begin, size_t end,
              ShadeScratch* scratch, ReflectedRadiance* radiance);

// The same of all hits of a batch, on one material without maps, with its coat, if it has one, over
// it. Prepares the run. `of_coat`: a buffer.
void ShadeWithCoat(const ShadingMaterial& material, const HitBatch& hits, const ShadingLight& light,
                   const LightBatch& on_hits, Surface* surface, ShadeScratch* scratch,
                   ReflectedRadiance* of_coat, ReflectedRadiance* radiance);

// Zeroes the first `count` entries.
void ClearSoa(size_t count, Soa3<float>* soa);
void ClearRadiance(size_t count, ReflectedRadiance* radiance);

}  // namespace nacre
