// SPDX-License-Identifier: Apache-2.0
// shading/lobe_sample.h: directions sampled from a surface's lobes, and their pdfs per solid angle.
#pragma once

#include "hit/batch.h"
#include "shading/hit_textures.h"
#include "shading/material.h"
#include "shading/surface.h"

namespace nacre {

// Whether SampleLobe applies to the material: it has, or with maps may have, a specular lobe that
// is not a perfect mirror's, or a mirror with Kulla and Conty's lobe.
bool HasSampledLobe(const ShadingMaterial& material);

// Whether the material's diffuse reflection is a function of the view direction times the light's
// irradiance: a Lambertian surface under nothing that depends on the direction of the light.
bool DiffuseIsFlat(const ShadingMaterial& material);

// Samples cosine-weighted directions about the normals, with pdf n.l / pi, from points (u, v) in
// [0, 1)^2.
void SampleCosine(const Surface& surface, size_t count, const float* u, const float* v,
                  Soa3<float>* to_light);

// Hits [begin, end) of a batch, all of one material.
struct LobeRange {
  const HitBatch& hits;
  const Surface& surface;
  size_t begin, end;
  const HitTextures* textures = nullptr;  // for materials with maps
};

// For materials with layers, replaces the directions that SampleCosine has made: the diffuse
// component includes the layers' own reflection, which may lie where cosine-weighted directions are
// rare. From the top down, each layer is sampled with a probability that is its fraction of the
// albedo; else a cosine-weighted direction is sampled. Hits whose layers reflect nothing keep their
// directions, as hits without layers do.
void SampleUnderLayers(const ShadingMaterial& material, const LobeRange& range, const float* u,
                       const float* v, Soa3<float>* to_light);
// Stores the pdf with which SampleUnderLayers chooses the directions, plus `light_pdf`, if that is
// not null. The pdf of hits whose layers reflect nothing is left as it is.
void UnderLayersPdf(const ShadingMaterial& material, const LobeRange& range,
                    const Soa3<float>& to_light, const float* light_pdf, float* pdf);

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
// channel for light from there.
void MirrorDirections(const LobeRange& range, Soa3<float>* to_light);
void MirrorReflectance(const ShadingMaterial& material, const LobeRange& range,
                       Soa3<float>* reflectance);

}  // namespace nacre
