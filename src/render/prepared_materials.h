// SPDX-License-Identifier: Apache-2.0
// render/prepared_materials.h: data derived from each of a scene's materials separately, so that a
// change of one material leaves the data of the others valid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "shading/material.h"

namespace nacre {

// Properties that a plan needs to know of all materials at once.
enum class MaterialTrait : uint32_t {
  kSplit = 1 << 0,
  kEmitsInFrontOnly = 1 << 1,
  kEmits = 1 << 2,
  kCoated = 1 << 3,
  kTextured = 1 << 4,     // ShadingMaterial::scene_material, its own or a coat's
  kDoubleTerms = 1 << 5,  // HasDoubleTerms, itself or a coat
  kMirror = 1 << 6,
  kCoatMirror = 1 << 7,
  kUserModel = 1 << 8,
  kBurleyGain = 1 << 9,  // BurleyGain above 1
  kPhongGain = 1 << 10,  // PhongGain, if it would not be printed as 1.00
  // The form of Shadowing of the lobe: this bit and the three bits after it, in the enum's order.
  kFirstShadowing = 1 << 11,
  kTransmits = 1 << 15,  // OpenPbrMaterial::transmission_weight above 0, which is not rendered
  kMeasured = 1 << 16,
  kHazy = 1 << 17,  // OpenPBR's haze or retroreflectivity above 0, which are not rendered
};

// A set of traits, as bits.
using MaterialTraits = uint32_t;

inline bool Has(MaterialTraits traits, MaterialTrait trait) {
  return (traits & static_cast<MaterialTraits>(trait)) != 0;
}

// The trait of the form of shadowing of the material's lobe; 0 without a lobe.
MaterialTraits ShadowingTrait(const Material& material);

struct PreparedMaterials {
  std::vector<ShadingMaterial> all;    // one per material of the scene, then `black`
  MaterialId black;                    // for the backs of materials that emit in front only
  std::vector<MaterialTraits> traits;  // by material of the scene
  MaterialTraits any = 0;              // traits of any material
  std::vector<double> phong_gains;     // PhongGain, by material of the scene
};

// Derives the data of all materials. `in_ambient` says whether the scene has ambient light. The
// scene must outlive the result. The former contents of `materials` are lost, but its memory is
// used again.
void PrepareMaterials(const Scene& scene, bool in_ambient, int threads,
                      PreparedMaterials* materials);
// Derives the data of the materials that have changed since.
void PrepareMaterials(const Scene& scene, bool in_ambient, std::span<const uint32_t> changed,
                      PreparedMaterials* materials);

// The share of grazing light that Burley's diffuse term reflects, in the brightest channel; 0 for
// other models.
double BurleyGain(const ShadingMaterial& material);

// The largest radiance, in the brightest channel, that a radiometric Phong material reflects in
// surroundings of radiance 1; else 0. With the classic convention, kd and ks are no reflectances
// that could exceed 1.
double PhongGain(const Material& material);

}  // namespace nacre
