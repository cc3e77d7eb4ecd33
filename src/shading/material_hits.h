// SPDX-License-Identifier: Apache-2.0
// shading/material_hits.h: the hits of a batch that lie on one material, by themselves and under
// one light. The functions of shading take them.
#pragma once

#include <memory>
#include <span>
#include <variant>

#include "hit/batch.h"
#include "scene/material.h"
#include "shading/hit_parameters.h"
#include "shading/light.h"
#include "shading/material.h"
#include "shading/surface.h"

namespace nacre {

// One coat over the hits of a batch, by index of the hit: the same positions, with the coat's
// shading normals, parameters and constants. Entries of hits without this coat are not used.
struct CoatHits {
  HitBatch hits;
  Surface surface;  // Surface::transmittance is what the coat does not reflect, before its tint
  std::unique_ptr<HitParameters> textures;  // made for the first coat with maps
  // The probability of sampling the coat's lobe rather than a glossy lobe below it; 0 for mirrors.
  AlignedArray<float> chance{kBatchCapacity};
};

// The tint of a coat at hit i. `maps` are the parameters of the coat's hits, or null if none has
// its own: a map of the strength of a coat weighs its tint, too.
inline Rgb TintAt(const ShadingMaterial& coat, const HitParameters* maps, size_t i) {
  if (maps == nullptr || !coat.by_hit.model || coat.tint == Rgb(1)) return coat.tint;
  const double whole = std::get<MetallicRoughnessMaterial>(coat.own->model).specular;
  return Rgb(1) - (Rgb(1) - coat.tint) * (NumbersOf(*maps, MappedNumber::kSpecular)[i] / whole);
}

// Hits [begin, end) of a batch, all of one material.
struct MaterialHits {
  const ShadingMaterial& material;
  const HitBatch& hits;
  const Surface& surface;
  size_t begin, end;
  HitParameters* textures = nullptr;     // for materials with maps
  std::span<const CoatHits> coats = {};  // at least those that the material has

  // The parameters of the hits if maps give each its own, else null.
  HitParameters* Maps() const { return material.by_hit.model ? textures : nullptr; }
};

// Hits of one material under one light, and where to store the radiance that they reflect.
struct LitHits : MaterialHits {
  const ShadingLight& light;
  const LightBatch* on_hits;  // the light at the hits; may be null if EvaluatedInPlace
  ReflectedRadiance* radiance;
  bool components = true;  // whether diffuse and specular radiance are stored, too
};

}  // namespace nacre
