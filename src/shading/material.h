// SPDX-License-Identifier: Apache-2.0
// shading/material.h: materials in the form that kernels need: the scene's parameters turned into
// the constants of each reflection model, once per plan and in double.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "shading/anisotropic_lobe.h"
#include "shading/coat_transmission.h"
#include "shading/layer.h"
#include "shading/models.h"

namespace nacre {

struct Coat;

struct Material;

// What differs from hit to hit.
struct VariesByHit {
  bool parameters = false;  // some parameters, or results that the renderer would else take once
  bool model = false;       // parameters of reflection are among them, not of emission alone
  bool width = false;       // so is the roughness, exponent or anisotropy of the lobe
  bool normal = false;      // the material is normal-mapped or bump-mapped
  bool tangent = false;     // the lobe is anisotropic, and reads Surface::tangent
};

// A material prepared for shading. The model of a split is std::monostate.
struct ShadingMaterial {
  Rgb of_ambient{0, 0, 0};  // the fraction of ambient light that is reflected
  Rgb emission{0, 0, 0};
  EmissionThrough emission_through = EmissionThrough::kBaseFactors;  // coats and fuzz above
  // For the albedo output layer: diffuse reflectance, or base colour, or F0 of a conductor.
  Rgb albedo{0, 0, 0};
  VariesByHit by_hit;
  // The scene material, if anything varies by hit, else null. Not owned; it must outlive this.
  // `model` then has the factors of the maps as parameters.
  const Material* scene_material = nullptr;
  bool in_ambient = false;  // the scene has ambient light, which the material reflects
  // Clear coats (scene/coat.h) over the model and its layers, from the bottom up. Each is a
  // material without a diffuse base, and has a shading normal of its own.
  std::vector<std::shared_ptr<const ShadingMaterial>> coats;
  CoatTransmission transmission;  // of a coat
  // The scene material of a coat, to which its `scene_material` points. Owned here, because the
  // scene has none. Null for other materials.
  std::shared_ptr<const Material> own;
  std::variant<std::monostate, MatteModel, PhongFamilyModel, MicrofacetModel, UserModel,
               MeasuredModel>
      model;
  Rotation<double> tangent_turn;   // of an anisotropic lobe: turns the coordinates' tangent
  std::vector<LayerModel> layers;  // over the model, from the bottom up, under the coats
};

// `in_ambient` is true in a scene with ambient light. `material` must outlive the result.
ShadingMaterial PrepareMaterial(const Material& material, bool in_ambient = false);

// A coat by itself, over `below`. `coat` is copied.
std::shared_ptr<const ShadingMaterial> MakeShadingCoat(const Coat& coat, const Material& below);

// For tables and curves, which have no hits: without maps (WithoutMaps) and ambient light. Needs
// `material` no longer.
ShadingMaterial PrepareWithoutMaps(const Material& material);

// The albedo of a coat, seen from v, at most 1.
Rgb CoatAlbedo(const ShadingMaterial& coat, const LobeCosines& v);

// The factor of a coat on light from n.l that is reflected below it and seen from v.
Rgb TransmittedByCoat(const ShadingMaterial& coat, const LobeCosines& v, double n_dot_l);

// One channel of the directional albedo, seen from v and including compensation, of the lobe that
// covers the base. In a mix with a metal, that is the dielectric's.
double CoverAlbedo(const MicrofacetModel& model, const LobeCosines& v, int channel);

// The light that the lobe loses from or to x because it would have to bounce again: 1 - the albedo
// for F = 1.
double LossOf(const MicrofacetModel& model, const LobeCosines& x);

// True if the material has a lobe whose terms are computed in double, or, with maps, may have.
bool HasDoubleTerms(const ShadingMaterial& material);

// True if the material has a perfect mirror's lobe.
bool HasDeltaLobe(const ShadingMaterial& material);

// True if a perfect mirror's lobe is among those of the material and its coats.
bool HasMirror(const ShadingMaterial& material);

// True if a lobe of the material or of a coat is anisotropic.
bool HasAnisotropicLobe(const ShadingMaterial& material);

}  // namespace nacre
