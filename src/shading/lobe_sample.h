// SPDX-License-Identifier: Apache-2.0
// shading/lobe_sample.h: directions sampled from single lobes of a model, without what lies over
// them, and their pdfs per solid angle. bsdf.h samples whole materials.
#pragma once

#include "hit/batch.h"
#include "shading/hit_parameters.h"
#include "shading/material.h"
#include "shading/surface.h"

namespace nacre {

// Whether SampleLobe applies to the material: it has, or with maps may have, a specular lobe that
// is not a perfect mirror's, or a mirror with Kulla and Conty's lobe.
bool HasSampledLobe(const ShadingMaterial& material);

// Hits [begin, end) of a batch, all of one material.
struct LobeRange {
  const HitBatch& hits;
  const Surface& surface;
  size_t begin, end;
  const HitParameters* textures = nullptr;  // for materials with maps
};

// Samples cosine-weighted directions about the normals of hits [begin, end), with pdf n.l / pi,
// from points (u, v) in [0, 1)^2. CosinePdfs gives this pdf; it is negative below the surface.
void SampleCosines(const Surface& surface, size_t begin, size_t end, const float* u, const float* v,
                   Soa3<float>* to_light);
void CosinePdfs(const Surface& surface, size_t begin, size_t end, const Soa3<float>& to_light,
                float* pdf);

// Samples directions from the material's lobe. For GGX it samples visible normals
// (SampleGgxVisible) or, in proportion, the lobe of Kulla and Conty's compensation, for which
// PrepareRun must have run; for the Phong family the lobe itself. Directions below the surface
// reflect nothing.
void SampleLobe(const ShadingMaterial& material, const LobeRange& range, const float* u,
                const float* v, ShadeScratch* scratch, Soa3<float>* to_light);

// The pdf with which SampleLobe chooses the directions light.to_light; 0 for materials without
// HasSampledLobe.
void LobePdf(const ShadingMaterial& material, const LobeRange& range, const LightBatch& light,
             ShadeScratch* scratch, float* pdf);

// IsMirror tells whether a hit of the range has a perfect mirror's lobe, AnyMirror whether any hit
// has. With maps this depends on the hit's roughness.
bool IsMirror(const ShadingMaterial& material, const LobeRange& range, size_t hit);
bool AnyMirror(const ShadingMaterial& material, const LobeRange& range);

// For perfect mirrors: the view direction mirrored about the normal, and the reflectance per
// channel for light from there, which is set for the model's roughness 0 at all hits.
void MirrorDirections(const LobeRange& range, Soa3<float>* to_light);
void MirrorReflectances(const ShadingMaterial& material, const LobeRange& range,
                        Soa3<float>* reflectance);

}  // namespace nacre
