// SPDX-License-Identifier: Apache-2.0
// scene/open_pbr.h: OpenPBR Surface of the Academy Software Foundation, version 1.1.1, and what the
// branch of version 1.2 adds: its parameters by their own names, and what its text leaves to
// implementers as options with names.
//
// The specification describes a slab of materials and calls every approximation of it conforming.
// Implementations differ by factors. Each open choice is therefore an option here, and a set of
// rules chooses all of them as one implementation does.
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "brdf/ggx.h"
#include "brdf/ggx_anisotropic.h"
#include "scene/handle.h"
#include "scene/model_options.h"
#include "scene/texture.h"

namespace nacre {

// Which implementation all options are those of, unless they are given one by one.
enum class OpenPbrRules : uint8_t {
  kSpec11,     // the text of 1.1.1, in its most exact form
  kSpec12,     // the text of the branch of version 1.2, as of 2026-04
  kMaterialX,  // the reference graph of 1.1.1, with MaterialX's nodes
  kAdobe,      // adobe/openpbr-bsdf, as of 2026-08
};

// How specular_weight acts on the dielectric's reflection.
enum class SpecularWeightRule : uint8_t {
  kIndex,         // scales F0 by changing the index, in refraction, too
  kIndexReflect,  // the same for reflection alone (version 1.2)
  kFactor,        // multiplies the reflection
};

// The Fresnel curve of a dielectric base below a coat of weight C.
enum class CoatFresnel : uint8_t {
  kRefractCosine,  // lerp(F(cos, base / air), F(cos in the coat, base / coat), C)
  kInvertRatio,    // the index lerp(base / air, base / coat, C), inverted if the coat is denser
  kIndexLerp,      // the index of what lies above is lerp(air, coat, C)
  kNone,           // as in air
};

// How a rough coat widens the highlights below it. r and c are the roughness of base and coat, n
// the index of the coat.
enum class CoatRoughening : uint8_t {
  kSpec,    // (r^4 + 2 c^4)^(1/4)
  kAdobe,   // (r^4 + (1 - 1 / n) c^4)^(1/4)
  kFit261,  // the fit of issue 261 of the specification
  kNone,
};

// How light that is reflected back and forth below the coat darkens the base.
enum class CoatDarkening : uint8_t { kSpec, kSpec12, kMaterialX, kAdobe };

// How a coat absorbs, and how a coat of partial weight does.
enum class CoatAbsorption : uint8_t {
  kPath,    // along the refracted paths of light and view
  kNormal,  // as at normal incidence, at every angle
};
enum class CoatPartial : uint8_t {
  kExponentThenLerp,  // lerp(1, color^path (1 - E), C)
  kLerpThenExponent,  // lerp(1, color, C)^path lerp(1, 1 - E, C)
  kPerCrossing,       // lerp(1, T_l, C) lerp(1, T_v, C) (1 - C E)
  kWholeProduct,      // lerp(1, T (1 - E) darkening, C)
};

// How the light that a lobe leaves to what is below it depends on directions.
enum class Layering : uint8_t {
  kView,        // 1 - E(n.v)
  kReciprocal,  // (1 - E(n.v)) (1 - E(n.l)) / (1 - mean of E)
};

// The E of the dielectric's lobe that the diffuse base is left by, where specular_color tints it.
enum class SpecularTintBelow : uint8_t {
  kUntinted,
  kComplementary,  // the base gets the colours that are not reflected
  kMaxChannel,
};

// The complex index of a metal below a film, of which F0 and the tint at 81.8 degrees are given.
enum class FilmMetal : uint8_t {
  kGulbrandsenF82,   // Gulbrandsen 2014 of F0 and the reflectance at 81.8 degrees
  kGulbrandsenTint,  // the same of F0 and specular_color
  kRealIndex,        // real, of F0 alone
};

// What a coat does to the reflectance of a metal below it.
enum class CoatMetal : uint8_t {
  kUnchanged,
  kGulbrandsen,  // F0 is that of the metal's index, as film_metal has it, over the coat's
};

// What lies above a film.
enum class FilmOutside : uint8_t {
  kCoat,  // the coat where it covers the base
  kAir,
};

// What coat and fuzz leave of the emission below them [Emission]. C is the coat's weight.
enum class EmissionThrough : uint8_t {
  kCoatPath,     // lerp(1, one crossing of the coat's medium, C)
  kCoatColor,    // lerp(1, coat_color, C): two crossings
  kBaseFactors,  // the factors of the base on the side of the viewer: one crossing, what coat and
                 // fuzz do not reflect, and the coat's darkening
  kMaterialX,    // lerp(1, coat_color (1 - F0) (1 - (1 - n.v)^5), C)
};

// The options that the text leaves open, each with what rules kSpec11 choose.
struct OpenPbrOptions {
  SpecularWeightRule specular_weight_rule = SpecularWeightRule::kIndex;
  CoatFresnel coat_fresnel = CoatFresnel::kRefractCosine;
  CoatRoughening coat_roughening = CoatRoughening::kSpec;
  CoatDarkening coat_darkening_rule = CoatDarkening::kSpec;
  CoatAbsorption coat_absorption = CoatAbsorption::kPath;
  CoatPartial coat_partial = CoatPartial::kExponentThenLerp;
  Layering layering = Layering::kView;
  Shadowing smith = Shadowing::kHeightCorrelated;
  Compensation compensation = Compensation::kKullaConty;
  SpecularTintBelow specular_tint_below = SpecularTintBelow::kUntinted;
  AlphaLimit alpha_max = AlphaLimit::kOne;
  ThinFilmForm film = ThinFilmForm::kSpectral;  // not kGltf
  FilmMetal film_metal = FilmMetal::kGulbrandsenF82;
  FilmOutside film_outside = FilmOutside::kCoat;
  CoatMetal coat_metal = CoatMetal::kUnchanged;
  EmissionThrough emission_through = EmissionThrough::kCoatPath;
  double film_fade_nm = 0;  // thinner films fade to none (ThinFilmShare)
  bool base_weight_in_rho = false;
};

// The options of a set of rules.
OpenPbrOptions OptionsOf(OpenPbrRules rules);

// The version whose text gives rules and defaults.
enum class OpenPbrVersion : uint8_t {
  k11,  // 1.1.1
  k12,  // the branch of 1.2: other rules, and emission by emission_weight
};

// The parameters, by the names, units and defaults of the specification. A fuzz lies over a coat,
// over a base that is a mix of metal and dielectric, the latter with a diffuse inside.
struct OpenPbrMaterial {
  OpenPbrOptions options{};
  double base_weight = 1;                    // in [0, 1]
  Rgb base_color{0.8, 0.8, 0.8};             // each in [0, 1]
  double base_diffuse_roughness = 0;         // in [0, 1]; 0: Lambert
  double base_metalness = 0;                 // in [0, 1]
  double specular_weight = 1;                // >= 0
  Rgb specular_color{1, 1, 1};               // each in [0, 1]
  double specular_roughness = 0.3;           // in [0, 1]
  double specular_roughness_anisotropy = 0;  // in [0, 1]
  double specular_ior = 1.5;
  // Version 1.2: a share of the lobe that is wider, how much wider, and the share that is reflected
  // back to where the light comes from. Kept, and noted when a picture is made, but not rendered.
  double specular_haze = 0;               // in [0, 1]
  double specular_haze_spread = 0.3;      // in [0, 1]
  double specular_retroreflectivity = 0;  // in [0, 1]
  double coat_weight = 0;                 // in [0, 1]
  // The transmittance of the coat there and back at normal incidence, each in [0, 1].
  Rgb coat_color{1, 1, 1};
  double coat_roughness = 0;             // in [0, 1]
  double coat_roughness_anisotropy = 0;  // in [0, 1]
  double coat_ior = 1.6;
  double coat_darkening = 1;    // in [0, 1]
  double fuzz_weight = 0;       // in [0, 1]
  Rgb fuzz_color{1, 1, 1};      // each in [0, 1]
  double fuzz_roughness = 0.5;  // in [0, 1]
  // Light that comes out where it went in: a diffuse base of its own colour.
  double subsurface_weight = 0;  // in [0, 1]
  Rgb subsurface_color{0.8, 0.8, 0.8};
  // What else the specification says of subsurfaces and of light that passes through: kept, and
  // noted when a picture is made, but not rendered.
  double subsurface_radius = 1;
  Rgb subsurface_radius_scale{1, 0.5, 0.25};
  double subsurface_scatter_anisotropy = 0;  // in [-1, 1]
  double transmission_weight = 0;            // in [0, 1]
  Rgb transmission_color{1, 1, 1};
  double transmission_depth = 0;
  Rgb transmission_scatter{0, 0, 0};
  double transmission_scatter_anisotropy = 0;  // in [-1, 1]
  double transmission_dispersion_scale = 0;    // in [0, 1]
  double transmission_dispersion_abbe_number = 20;
  double thin_film_weight = 0;       // in [0, 1]
  double thin_film_thickness = 0.5;  // in micrometres
  double thin_film_ior = 1.4;
  // The radiance is the product of the three. The weight is of version 1.2.
  double emission_weight = 1;     // in [0, 1]
  double emission_luminance = 0;  // >= 0, in the scene's unit of radiance
  Rgb emission_color{1, 1, 1};    // each >= 0
  // The angles by which the tangents of base and coat are turned about the normal, towards the
  // bitangent: geometry_tangent and geometry_coat_tangent.
  double geometry_tangent_deg = 0, geometry_coat_tangent_deg = 0;
  TextureId base_color_map{};
  TextureId base_metalness_map{};
  TextureId specular_color_map{};
  TextureId specular_roughness_map{};
  TextureId fuzz_color_map{};
  TextureId fuzz_roughness_map{};
};

// The roughness of the coat. By coat_roughening kAdobe, fuzz widens it: c^4 becomes
// c^4 + 0.005 m f^5 where there is fuzz, of roughness f and a colour whose mean is m.
double CoatRoughnessOf(const OpenPbrMaterial& material);

// The defaults of a version.
OpenPbrMaterial DefaultsOf(OpenPbrVersion version);

}  // namespace nacre
