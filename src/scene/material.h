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
#include "scene/handle.h"
#include "scene/texture.h"

namespace nacre {

// How the Phong family's coefficients are read.
//   kClassic: the equations as the lessons write them: no 1/pi, no lobe normalisation; the
//     light's irradiance perpendicular to it takes the place of I_l.
//   kRadiometric: kd/pi, and lobes normalised so that ks is what they reflect of light from along
//     the normal (brdf/phong.h); comparable with the physical models under the same light.
enum class PhongConvention : uint8_t { kClassic, kRadiometric };

enum class PhongModel : uint8_t {
  kPhong,          // ks (r.v)^n where n.l > 0 (Phong 1975, gated), without n.l
  kModifiedPhong,  // ks (r.v)^n n.l (Lewis 1994)
  kBlinnPhong,     // ks (n.h)^n where n.l > 0 (Blinn 1977), without n.l
};

struct LambertMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  TextureId albedo_map{};
};

// Rough clay, plaster, the moon: as bright at its edge as in its middle. Keeps energy (brdf/eon.h).
struct OrenNayarMaterial {
  Rgb albedo{0.5, 0.5, 0.5};  // each in [0, 1]
  double roughness = 0.5;     // the model's own, in [0, 1]; 0: Lambert's
  TextureId albedo_map{};
};

// Disney's diffuse term (brdf/burley.h), fitted to measurements. Makes light at grazing angles.
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
  TextureId diffuse_map{};    // of color kd and color ka
  TextureId specular_map{};   // of ks
  TextureId shininess_map{};  // of the exponent
};

// The light that bounces more than once between microfacets, which a single-scattering lobe
// loses: 59 % of it at roughness 1.
enum class Compensation : uint8_t {
  kTurquin,     // scales the lobe to what the viewer lacks (Turquin 2019); not reciprocal
  kKullaConty,  // adds a diffuse-like lobe (Kulla and Conty 2017); reciprocal
  kNone,        // single scattering, energy lost
};

// How much light the diffuse base gets from under the specular lobe.
enum class DiffuseCoupling : uint8_t {
  kAlbedoScaled,     // what the dielectric's albedo leaves: a white surface reflects exactly all
  kOneMinusFresnel,  // 1 - F(v.h), the lesson's; a white surface may reflect 1.8 times the light
  kNone,             // all of it
};

// What a sheen leaves to the layers below it, and so whether a white surface reflects all light.
enum class SheenScaling : uint8_t {
  kReciprocal,  // by the darker side, of viewer and light: loses up to 14 %
  kConserving,  // by the viewer's side alone; not reciprocal
};

// How the diffuse base of a microfacet model reflects.
enum class DiffuseForm : uint8_t { kLambert, kOrenNayar, kBurley };

// The microfacet models have a GGX lobe each. Roughness is perceptual, in [0, 1]:
// alpha = roughness^2; below kDeltaRoughness (brdf/ggx.h) it is a perfect mirror.

// Metallic-roughness as in glTF 2.0 with KHR_materials_ior and KHR_materials_specular: by metallic
// a mix of GGX with Schlick's Fresnel from specular dielectric_f0 to specular, over a diffuse base
// base_color / pi, and of GGX with Schlick's Fresnel from base_color to 1.
struct MetallicRoughnessMaterial {
  Rgb base_color{0.8, 0.8, 0.8};  // each in [0, 1]
  double metallic = 0;            // in [0, 1]
  // What it reflects at normal incidence where it is no metal; each in [0, 1].
  Rgb dielectric_f0{0.04, 0.04, 0.04};
  double specular = 1;  // in [0, 1]: how much of that there is, at all angles
  // What Schlick's reflectance at cosine 1/7 (81.8 degrees) is multiplied by (Kutz et al. 2021):
  // the dip of real metals just before grazing. 1: Schlick's curve itself.
  Rgb f82_tint{1, 1, 1};  // each in [0, 1]
  double roughness = 0.5;
  Shadowing shadowing = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kTurquin;
  DiffuseCoupling diffuse_coupling = DiffuseCoupling::kAlbedoScaled;
  DiffuseForm diffuse = DiffuseForm::kLambert;
  std::optional<double> diffuse_roughness{};  // of the base, in [0, 1]; none: the lobe's
  TextureId base_color_map{};
  TextureId metallic_roughness_map{};  // as in glTF: green multiplies roughness, blue metallic
  TextureId specular_map{};            // of `specular`
  TextureId specular_color_map{};      // of dielectric_f0
  // A clear coat over all of that (CoatOf): how much of it there is, its roughness, and its index
  // of refraction. As KHR_materials_clearcoat of glTF, but that what is below gets what the coat's
  // albedo leaves.
  double coat = 0;                 // in [0, 1]
  double coat_roughness = 0;       // in [0, 1]
  double coat_ior = 1.5;           // in [1, 10]
  TextureId coat_map{};            // red multiplies coat
  TextureId coat_roughness_map{};  // green multiplies coat_roughness
  NormalMap coat_normal_map{};     // of the coat alone, which the normal map of the base is not for
  // The fuzz of cloth (brdf/sheen.h), between the coat and the rest, as KHR_materials_sheen.
  Rgb sheen_color{0, 0, 0};    // each in [0, 1]; 0: none
  double sheen_roughness = 0;  // in [0, 1]; 0: none is seen
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

// A clear coat of index of refraction `ior` over a diffuse base; nothing is transmitted, so a
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
  std::optional<double> diffuse_roughness{};  // of the base, in [0, 1]; none: the lobe's
  TextureId base_color_map{};
  TextureId roughness_map{};
};

// Not a model of its own: chooses among other materials by where the sample lies on screen, in
// vertical bands. materials.size() == at.size() + 1; `at` ascends in (0, 1), as fractions of the
// image width.
struct SplitMaterial {
  std::vector<double> at;
  std::vector<MaterialId> materials;
};

struct UserBrdf;  // scene/user_brdf.h

struct Material {
  std::string name;
  Rgb emission{0, 0, 0};  // radiance, >= 0
  // Only spheres' outsides and triangles' fronts emit (from where their corners run
  // counter-clockwise).
  bool emits_in_front_only = false;
  std::variant<LambertMaterial, PhongMaterial, MetallicRoughnessMaterial, ConductorMaterial,
               DielectricMaterial, SplitMaterial, OrenNayarMaterial, BurleyMaterial>
      model;
  // Meshes only: triangles have fronts alone. From behind no ray meets them: none of the camera,
  // and no light.
  bool single_sided = false;
  // A reflection model of the caller's own, in the place of the model's lobes; or null. All else
  // that the model says holds: coat, sheen, albedo, what it reflects of ambient light.
  std::shared_ptr<const UserBrdf> user{};
  // Maps multiply the numbers beside them.
  TextureId emission_map{};
  NormalMap normal_map{};
  BumpMap bump_map{};
  VertexColors vertex_colors = VertexColors::kNone;
  // Holes in meshes, as glTF's alphaMode MASK: the surface is there where opacity, times its map
  // and the mesh's opacities, is at least the cutoff, and elsewhere nothing is, for no ray. A
  // cutoff above 1 leaves nothing. The map is looked up in the image itself, never in a smaller
  // copy.
  double opacity = 1;           // in [0, 1]
  double opacity_cutoff = 0.5;  // >= 0
  TextureId opacity_map{};
};

}  // namespace nacre
