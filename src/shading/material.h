// SPDX-License-Identifier: Apache-2.0
// shading/material.h: materials in the form that kernels need: the scene's parameters turned into
// the constants of each reflection model, once per plan and in double.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "scene/material.h"
#include "shading/layer.h"
#include "shading/models.h"

namespace nacre {

// A material prepared for shading. The model of a split is std::monostate.
struct ShadingMaterial {
  Rgb of_ambient{0, 0, 0};  // the fraction of ambient light that is reflected
  Rgb emission{0, 0, 0};
  // For the albedo output layer: diffuse reflectance, or base colour, or F0 of a conductor.
  Rgb albedo{0, 0, 0};
  // The scene material, if parameters or results depend on the hit: where there are maps, and where
  // a coat or a layer covers ambient light or emission. Else null. Not owned; it must outlive this.
  // `model` then has the factors of the maps as parameters.
  const Material* textured = nullptr;
  bool mapped = false;        // each hit has parameters of its own
  bool mapped_model = false;  // these include parameters of reflection, not of emission alone
  bool mapped_width = false;  // these include the roughness or exponent of the lobe
  bool turned = false;        // the material is normal-mapped or bump-mapped
  bool in_ambient = false;    // the scene has ambient light, which the material reflects
  // The clear coat (scene/coat.h), or null. It is shaded as a surface of its own.
  std::shared_ptr<const ShadingMaterial> coat;
  // The scene material of a coat, to which its `textured` points. Owned here, because the scene has
  // none. Null for other materials.
  std::shared_ptr<const Material> own;
  std::variant<std::monostate, MatteModel, PhongFamilyModel, MicrofacetModel, UserModel> model;
  std::vector<LayerModel> layers;  // over the model, bottom to top, under the coat
};

// `in_ambient` is true in a scene with ambient light. `material` must outlive the result.
ShadingMaterial PrepareMaterial(const Material& material, bool in_ambient = false);

// Removes the maps, so that all hits have the maps' factors as parameters.
void DropMaps(ShadingMaterial* material);

// The transmittance of a coat for light from below, seen from n.v: 1 minus its albedo.
Rgb LeftByCoat(const ShadingMaterial& coat, double n_dot_v);

// One channel of the directional albedo, seen from n.v and including compensation, of the lobe that
// covers the base. In a mix with a metal, that is the dielectric's.
double CoverAlbedo(const MicrofacetModel& model, double n_dot_v, int channel);

// True if the material has a lobe whose terms are computed in double, or, with maps, may have.
bool HasDoubleTerms(const ShadingMaterial& material);

// True if the material has a perfect mirror's lobe.
bool HasDeltaLobe(const ShadingMaterial& material);

}  // namespace nacre
