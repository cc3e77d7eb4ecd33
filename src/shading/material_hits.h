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
  Surface surface;  // Surface::transmittance is what the coat's lobe does not reflect
  // The factor on what lies below (CoatFactors). `along_light` is written only if the coat absorbs
  // along the light's path (AbsorbsAlongLight); what else would be in it is in `constant`.
  Soa3<float> constant, along_light;
  Soa3<float> log2_medium;                  // half the logarithm of the medium's colour; likewise
  std::unique_ptr<HitParameters> textures;  // made for the first coat with maps
  // The probability of sampling the coat's lobe rather than a glossy lobe below it; 0 for mirrors.
  AlignedArray<float> chance{kBatchCapacity};
};

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
