// SPDX-License-Identifier: Apache-2.0
// shading/bsdf.h: what the material of a run of hits makes of light, asked in one place: evaluate,
// pdf and sample. Scalar twin: scalar_bsdf.h.
//
// A material is a stack of lobes. From the bottom up: a diffuse base, the glossy lobe of its model,
// layers (layer.h) and clear coats, which are glossy lobes with shading normals of their own. Each
// level reflects some of the light itself and attenuates what all levels below it reflect. Each
// lobe is of a kind (LobeKind), which tells the component of radiance that it counts to.
//
// Only lobes of one kind are sampled at a time: a renderer that shows diffuse and specular
// components, or finds one of them in closed form, samples them apart. SampleBsdf chooses between
// the kinds.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "shading/light.h"
#include "shading/lobe_chances.h"
#include "shading/material_hits.h"
#include "shading/reflection.h"
#include "shading/surface.h"

namespace nacre {

// Where to store the pdfs, per solid angle, with which SampleLobes chooses the direction to the
// light from the lobes of each kind. Null if they are not asked for.
struct LobePdfs {
  float* diffuse = nullptr;
  float* glossy = nullptr;
};

// Buffers of EvaluateBsdf for lobes that are mirrored at the horizon.
struct MirroredLobe {
  LightBatch light;  // mirrored in the surface; irradiance 0 at hits that reflect none of it
  ReflectedRadiance radiance;
  AlignedArray<float> pdf{kBatchCapacity};
};

// Buffers of SampleLobes for stacks.
struct StackRoom {
  // The lobe that was chosen for a hit: the model's, that of coat kCoatLobe + k, or one whose
  // direction `to_light` holds already.
  using Lobe = size_t;
  static constexpr Lobe kModelLobe = 0, kSampled = 1, kCoatLobe = 2;
  AlignedArray<Lobe> lobe{kBatchCapacity};
  AlignedArray<float> u{kBatchCapacity};  // rescaled to [0, 1) for the chosen lobe
  Soa3<float> to_light;
};

// Buffers of the functions below.
struct BsdfRoom {
  ShadeScratch shade;
  std::unique_ptr<MirroredLobe> mirrored;      // made for the first normal-mapped lobe
  std::unique_ptr<ReflectedRadiance> of_coat;  // made for the first coat
  AlignedArray<float> coat_pdf;                // likewise
  std::unique_ptr<StackRoom> stack;            // made for the first stack that is sampled
};

// Makes the hits of a coat of a batch whose normals have not been mapped yet.
void CopyToCoat(const HitBatch& hits, const Surface& surface, CoatHits* coat);

// Computes the terms of hits [begin, end) that do not depend on the light. The maps of the material
// and of its coats must have been looked up (textures.h).
void PrepareBsdf(const ShadingMaterial& material, size_t begin, size_t end, HitParameters* textures,
                 Surface* surface, std::span<CoatHits> coats);

// The factor of coat k of the material on light that is reflected below it, at hit i, from a
// direction whose cosine with the coat's normal is n_dot_l. PrepareBsdf must have run.
Rgb TransmittedAt(const MaterialHits& at, size_t k, size_t i, double n_dot_l);

// The factor of coat k on what the material emits, at hit i. PrepareBsdf must have run.
Rgb EmittedThroughCoat(const MaterialHits& at, size_t k, size_t i);

// Sets the light's irradiance to 0 at hits of a normal-mapped batch (Surface::normal_mapped) where
// no lobe faces the light (normal_map_kernel.cc).
void HideUnreflectedLight(const MaterialHits& at, LightBatch* light);

// Whether the hits' BSDF needs EvaluateLight: if false, EvaluateBsdf evaluates lights for which
// EvaluatedInPlace is true itself, with the same bits.
inline bool NeedsLightAtHits(const ShadingMaterial& material) {
  return material.by_hit.normal || !material.coats.empty() || !material.layers.empty();
}

// Stores what the hits reflect of the light, f |n.l| times its irradiance and colour, and the pdfs
// of the light's directions that are asked for, which hold where its irradiance is above 0.
// lit.on_hits may be null unless NeedsLightAtHits or pdfs are asked for. Light from below the
// horizon is 0.
void EvaluateBsdf(const LitHits& lit, BsdfRoom* room, const LobePdfs& pdfs = {});

// Whether the material has, or with maps may have, a lobe of this kind to sample. kDelta is not
// answered here, but hit by hit (AnyMirror).
bool HasLobes(const ShadingMaterial& material, LobeKind kind);

// Samples directions to light from the material's lobes of one kind, kDiffuse or kGlossy, with
// points (u, v) in [0, 1)^2. From the top down, each lobe is sampled with a probability that is
// about its fraction of the albedo of these lobes. Directions below the surface reflect nothing.
// Without such lobes, directions are left as they are.
void SampleLobes(const MaterialHits& at, LobeKind kind, const float* u, const float* v,
                 BsdfRoom* room, Soa3<float>* to_light);

// Whether any of the hits has a perfect mirror's lobe at a level: the model is level 0, coat k
// level 1 + k. With maps this depends on the hit's roughness.
bool AnyMirror(const MaterialHits& at, size_t level);

// Sets `to_light` to the view direction mirrored about the normal of the level, and `weight` to the
// radiance reflected of radiance 1 from there, attenuated by the levels above; 0 at hits that have
// no mirror at this level. Both are left as they are if none has. Returns AnyMirror.
bool SampleMirror(const MaterialHits& at, size_t level, Soa3<float>* to_light, Soa3<float>* weight);

// One direction for each hit, sampled from the whole material.
struct BsdfSamples {
  Soa3<float> to_light;
  Soa3<float> weight;  // f |n.l| / pdf; 0 for directions below the surface
  // Per solid angle, of all lobes but mirrors, if the direction is above the surface; for a sample
  // of a mirror, the probability of the mirror. 0 where no lobe reflects anything.
  AlignedArray<float> pdf{kBatchCapacity};
  AlignedArray<LobeKind> kind{kBatchCapacity};  // of the lobe that was sampled
};

// Buffers of SampleBsdf.
struct SampleRoom {
  std::vector<KindChances> chances{kBatchCapacity};
  AlignedArray<size_t> chosen{kBatchCapacity};  // ChooseKind
  AlignedArray<float> u{kBatchCapacity};
  Soa3<float> to_light, mirrored;  // directions of one kind, and weights of mirrors
  LightBatch light;
  ReflectedRadiance reflected;
  AlignedArray<float> diffuse_pdf{kBatchCapacity}, glossy_pdf{kBatchCapacity};
};

// Samples directions from the whole material with points (u, v) in [0, 1)^2: chooses a kind of
// lobe, in proportion to an estimate of each kind's albedo, and samples the lobes of this kind.
void SampleBsdf(const MaterialHits& at, const float* u, const float* v, BsdfRoom* room,
                SampleRoom* sample, BsdfSamples* samples);

// Whether the material's diffuse reflection is a function of the view direction times the light's
// irradiance: a Lambertian surface under nothing that depends on the direction of the light.
bool DiffuseIsFlat(const ShadingMaterial& material);

// PrepareBsdf and EvaluateBsdf for all hits of a batch, which must be on one material, without
// maps. `coats` is a buffer.
void EvaluateBatch(const ShadingMaterial& material, const HitBatch& hits, const ShadingLight& light,
                   const LightBatch& on_hits, Surface* surface, std::vector<CoatHits>* coats,
                   BsdfRoom* room, ReflectedRadiance* radiance);

}  // namespace nacre
