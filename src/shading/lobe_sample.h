// SPDX-License-Identifier: Apache-2.0
// shading/lobe_sample.h: directions sampled from single lobes of a model, without what lies over
// them, and their pdfs per solid angle. bsdf.h samples whole materials.
#pragma once

#include "shading/material_hits.h"

namespace nacre {

// Whether SampleLobe applies to the material: it has, or with maps may have, a specular lobe that
// is not a perfect mirror's, or a mirror with Kulla and Conty's lobe.
bool HasSampledLobe(const ShadingMaterial& material);

// Samples cosine-weighted directions about the normals, with pdf n.l / pi, from points (u, v) in
// [0, 1)^2. CosinePdfs gives this pdf; it is negative below the surface.
void SampleCosines(const MaterialHits& at, const float* u, const float* v, Soa3<float>* to_light);
void CosinePdfs(const MaterialHits& at, const Soa3<float>& to_light, float* pdf);

// Samples directions from the material's lobe. For GGX it samples visible normals
// (SampleGgxVisible) or, in proportion, the lobe of Kulla and Conty's compensation, for which
// PrepareRun must have run; for the Phong family the lobe itself. Directions below the surface
// reflect nothing.
void SampleLobe(const MaterialHits& at, const float* u, const float* v, ShadeScratch* scratch,
                Soa3<float>* to_light);

// The pdf with which SampleLobe chooses the directions of light; 0 for materials without
// HasSampledLobe.
void LobePdf(const MaterialHits& at, const LightBatch& light, ShadeScratch* scratch, float* pdf);

// IsMirror tells whether a hit has a perfect mirror's lobe, AnyMirror whether any of the hits has.
// With maps this depends on the hit's roughness.
bool IsMirror(const MaterialHits& at, size_t hit);
bool AnyMirror(const MaterialHits& at);

// For perfect mirrors: the view direction mirrored about the normal, and the reflectance per
// channel for light from there, which is set for the model's roughness 0 at all hits.
void MirrorDirections(const MaterialHits& at, Soa3<float>* to_light);
void MirrorReflectances(const MaterialHits& at, Soa3<float>* reflectance);

// The following take the unmapped surface, whose normal is Surface::interpolated_normal, as the
// horizon of normal-mapped hits (normal_map_kernel.cc).

// Mirrors the hits' directions that lie below the horizon in the unmapped surface, so that none
// does, up to rounding. Directions behind the normal-mapped normal are left as they are.
void RaiseAboveHorizon(const MaterialHits& at, Soa3<float>* to_light);

// Stores the light of the hits, mirrored in the unmapped surface, along unit vectors. Where the
// normal-mapped normal faces the mirrored light, its irradiance is that of `light`; elsewhere the
// irradiance is 0, and the direction the normal itself. Returns whether any irradiance is left.
bool MirrorAtHorizon(const MaterialHits& at, const LightBatch& light, LightBatch* mirrored);

}  // namespace nacre
