// SPDX-License-Identifier: Apache-2.0
// shading/lobe_sample.h: directions chosen by what a surface reflects, and how densely, per solid
// angle.
#pragma once

#include "hit/batch.h"
#include "shading/material.h"
#include "shading/shade.h"
#include "shading/textures.h"

namespace nacre {

// Whether SampleLobe is for the material: it has a specular lobe that is no perfect mirror's, or a
// mirror with Kulla and Conty's lobe, or, by maps, may have one.
bool HasSampledLobe(const ShadingMaterial& material);

// Whether its diffuse reflection of a light is a function of the viewer's direction times the
// light's irradiance: Lambert's, under nothing that asks for the light's direction.
bool DiffuseIsFlat(const ShadingMaterial& material);

// Directions by the cosine law about the normals, with pdf n.l / pi, by points (u, v) in
// [0, 1)^2.
void SampleCosine(const Surface& surface, size_t count, const float* u, const float* v,
                  Soa3<float>* to_light);

// Hits [begin, end) of a batch, all of one material.
struct LobeRange {
  const HitBatch& hits;
  const Surface& surface;
  size_t begin, end;
  const HitTextures* textures = nullptr;  // of materials with maps
};

// Of materials with layers, in the place of the directions that SampleCosine has made: the diffuse
// component has the layers' own reflection, which may lie where the cosine law has few directions.
// From the top down each layer is sampled as often as its share of the albedo is, and the cosine
// law otherwise. Hits whose layers reflect nothing keep what is there, as hits without layers do.
void SampleUnderLayers(const ShadingMaterial& material, const LobeRange& range, const float* u,
                       const float* v, Soa3<float>* to_light);
// The pdf with which it chooses the directions, plus `light_pdf`, if that is not null. The pdf of
// hits whose layers reflect nothing stays.
void UnderLayersPdf(const ShadingMaterial& material, const LobeRange& range,
                    const Soa3<float>& to_light, const float* light_pdf, float* pdf);

// Directions by the material's lobe: the visible normals of a GGX lobe (SampleGgxVisible),
// shared out between it and the lobe of Kulla and Conty's compensation, of which PrepareRun must
// have run; the lobe itself of the Phong family. Directions below the surface reflect nothing.
void SampleLobe(const ShadingMaterial& material, const LobeRange& range, const float* u,
                const float* v, ShadeScratch* scratch, Soa3<float>* to_light);

// The pdf with which SampleLobe chooses the directions light.to_light; 0 of materials that it
// is not for.
void LobePdf(const ShadingMaterial& material, const LobeRange& range, const LightBatch& light,
             ShadeScratch* scratch, float* pdf);

// Whether a hit of the range, or any, has a perfect mirror's lobe: the material's, or by maps that
// give each hit a roughness.
bool IsMirror(const ShadingMaterial& material, const LobeRange& range, size_t hit);
bool AnyMirror(const ShadingMaterial& material, const LobeRange& range);

// Where perfect mirrors look: the view direction mirrored in the normal, and what the mirror
// reflects of light from there, per channel.
void MirrorDirections(const LobeRange& range, Soa3<float>* to_light);
void MirrorReflectance(const ShadingMaterial& material, const LobeRange& range,
                       Soa3<float>* reflectance);

}  // namespace nacre
