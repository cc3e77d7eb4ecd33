// SPDX-License-Identifier: Apache-2.0
// scene/material.h: the shading models and their parameters.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "brdf/ggx.h"
#include "brdf/measured_table.h"
#include "scene/handle.h"
#include "scene/model_options.h"
#include "scene/open_pbr.h"
#include "scene/texture.h"

namespace nacre {

struct LambertMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  TextureId albedo_map{};
};

// Rough clay, plaster, the moon: as bright at the edge as in the middle. Conserves energy
// (brdf/eon.h).
struct OrenNayarMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  double roughness = 0.5;     // the model's own, in [0, 1]; 0: Lambert
  TextureId albedo_map{};
};

// Disney's diffuse term (brdf/burley.h), fitted to measurements. Gains energy at grazing angles.
struct BurleyMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  double roughness = 0.5;     // perceptual, in [0, 1]
  TextureId albedo_map{};
};

struct PhongMaterial {
  PhongModel model = PhongModel::kPhong;
  PhongConvention convention = PhongConvention::kRadiometric;
  Rgb color{1, 1, 1};  // multiplies ambient and diffuse
  Rgb ka{0.1, 0.1, 0.1};
  Rgb kd{0.7, 0.7, 0.7};
  Rgb ks{0.3, 0.3, 0.3};
  double shininess = 32;      // exponent n >= 0
  TextureId diffuse_map{};    // multiplies color
  TextureId specular_map{};   // multiplies ks
  TextureId shininess_map{};  // multiplies shininess
};

// The microfacet models have a GGX lobe each. Roughness is perceptual, in [0, 1]:
// alpha = roughness^2; below kDeltaRoughness (brdf/ggx.h) it is a perfect mirror.

// Metallic-roughness as in glTF 2.0 with KHR_materials_ior and KHR_materials_specular: a mix, by
// metallic, of a dielectric and a metal. The dielectric is a GGX lobe whose Schlick Fresnel goes
// from specular dielectric_f0 to specular, over a diffuse base base_color / pi. The metal is a GGX
// lobe whose Schlick Fresnel goes from base_color to 1.
struct MetallicRoughnessMaterial {
  Rgb base_color{0.8, 0.8, 0.8};  // each in [0, 1]
  double metallic = 0;            // in [0, 1]
  // Reflectance of the dielectric at normal incidence; each in [0, 1].
  Rgb dielectric_f0{0.04, 0.04, 0.04};
  double specular = 1;  // in [0, 1]: strength of the dielectric's reflection at all angles
  // Factor on the metal's Schlick reflectance at cosine 1/7 (81.8 degrees; Kutz et al. 2021): the
  // dip of real metals just before grazing incidence. 1: Schlick's curve itself.
  Rgb f82_tint{1, 1, 1};  // each in [0, 1]
  double roughness = 0.5;
  // As KHR_materials_anisotropy: the lobe is wider along the tangent, which is turned about the
  // normal towards the bitangent.
  double anisotropy = 0;  // in [0, 1]
  double anisotropy_rotation_deg = 0;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  DiffuseCoupling diffuse_coupling = DiffuseCoupling::kAlbedoScaled;
  DiffuseForm diffuse = DiffuseForm::kLambert;
  std::optional<double> diffuse_roughness{};  // of the base, in [0, 1]; nullopt: `roughness`
  TextureId base_color_map{};
  // Blue multiplies anisotropy; red and green, of which 0.5 stands for 0, are the direction, in the
  // frame of the tangent, before it is turned.
  TextureId anisotropy_map{};
  TextureId metallic_roughness_map{};  // as in glTF: green multiplies roughness, blue metallic
  TextureId specular_map{};            // multiplies specular
  TextureId specular_color_map{};      // multiplies dielectric_f0
  // The strength, roughness and index of refraction of a clear coat over all of the above
  // (CoatsOf). As glTF's KHR_materials_clearcoat, except that the layers below get what the coat's
  // albedo leaves.
  double coat = 0;                 // in [0, 1]
  double coat_roughness = 0;       // in [0, 1]
  double coat_ior = 1.5;           // in [1, 10]
  TextureId coat_map{};            // red multiplies coat
  TextureId coat_roughness_map{};  // green multiplies coat_roughness
  NormalMap coat_normal_map{};     // of the coat, which normal_map does not affect
  // A thin film on dielectric and metal alike, as KHR_materials_iridescence.
  double iridescence = 0;  // in [0, 1]: the fraction that it covers
  double iridescence_ior = 1.3;
  double iridescence_thickness_nm = 400;
  ThinFilmForm iridescence_model = ThinFilmForm::kGltf;
  TextureId iridescence_map{};  // red multiplies iridescence
  // Green interpolates between the minimum, where it is 0, and iridescence_thickness_nm.
  TextureId iridescence_thickness_map{};
  double iridescence_thickness_minimum_nm = 100;
  // The sheen of cloth (brdf/sheen.h), between the coat and the other layers, as
  // KHR_materials_sheen.
  Rgb sheen_color{0, 0, 0};    // each in [0, 1]; 0: none
  double sheen_roughness = 0;  // in [0, 1]; 0: none
  SheenScaling sheen_scaling = SheenScaling::kReciprocal;
  TextureId sheen_color_map{}, sheen_roughness_map{};
};

enum class ConductorFresnel : uint8_t {
  kExact,    // unpolarised, of the complex index eta - i k
  kF82Tint,  // through its values at normal incidence and at cosine 1/7
  kSchlick,  // through its value at normal incidence
};

// A bare metal of complex index of refraction eta - i k, per channel.
struct ConductorMaterial {
  Rgb eta{0.2, 0.2, 0.2};  // > 0; the defaults are a grey like silver's
  Rgb k{3, 3, 3};          // >= 0
  double roughness = 0.5;
  ConductorFresnel fresnel = ConductorFresnel::kExact;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  TextureId roughness_map{};
};

enum class DielectricFresnel : uint8_t { kExact, kSchlick };

// A dielectric coat of index of refraction `ior` over a diffuse base. Nothing is transmitted, so a
// black base shows the reflection of glass alone.
struct DielectricMaterial {
  Rgb base_color{0.8, 0.8, 0.8};  // each in [0, 1]
  double ior = 1.5;               // in [1, 10]
  double roughness = 0.5;
  DielectricFresnel fresnel = DielectricFresnel::kExact;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  DiffuseCoupling diffuse_coupling = DiffuseCoupling::kAlbedoScaled;
  DiffuseForm diffuse = DiffuseForm::kLambert;
  std::optional<double> diffuse_roughness{};  // of the base, in [0, 1]; nullopt: `roughness`
  TextureId base_color_map{};
  TextureId roughness_map{};
};

// A BRDF that was measured, of a file of the MERL database or of EPFL's. All that it reflects
// counts as specular.
struct MeasuredMaterial {
  std::string file{};                          // as the scene names it
  std::shared_ptr<const MeasuredBrdf> brdf{};  // what the file contains; null: black
  MeasuredInterpolation interpolation = MeasuredInterpolation::kLinear;
};

// Not a model of its own: chooses among other materials by the vertical band of the image that a
// sample lies in. materials.size() == at.size() + 1; `at` ascends in (0, 1), as fractions of the
// image width.
struct SplitMaterial {
  std::vector<double> at;
  std::vector<MaterialId> materials;
};

struct UserBrdf;  // scene/user_brdf.h

struct Material {
  std::string name{};
  Rgb emission{0, 0, 0};  // radiance, >= 0
  // Whether spheres emit only outwards, and triangles only from their fronts: the side from which
  // their corners run counter-clockwise.
  bool emits_in_front_only = false;
  std::variant<LambertMaterial, PhongMaterial, MetallicRoughnessMaterial, ConductorMaterial,
               DielectricMaterial, SplitMaterial, OrenNayarMaterial, BurleyMaterial,
               OpenPbrMaterial, MeasuredMaterial>
      model{};
  // Meshes only: triangles have only fronts. Rays of the camera and of lights pass through them
  // from behind.
  bool single_sided = false;
  // A BRDF of the caller's that replaces the model's lobes, or null. All else is as the model says:
  // coat, sheen, albedo, and the reflection of ambient light.
  std::shared_ptr<const UserBrdf> user{};
  // A map multiplies the parameter that it is named after.
  TextureId emission_map{};
  NormalMap normal_map{};
  BumpMap bump_map{};
  VertexColors vertex_colors = VertexColors::kNone;
  // Holes in meshes, as glTF's alphaMode MASK: the surface exists where opacity, times its map and
  // the mesh's opacities, is at least the cutoff; elsewhere all rays pass through. A cutoff above 1
  // leaves no surface. The map is looked up in the full-resolution image, never in a mip level.
  double opacity = 1;           // in [0, 1]
  double opacity_cutoff = 0.5;  // >= 0
  TextureId opacity_map{};
};

// The radiance that the surface emits, without its map: `emission`, and OpenPBR's.
Rgb EmissionOf(const Material& material);

}  // namespace nacre
