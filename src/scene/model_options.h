// SPDX-License-Identifier: Apache-2.0
// scene/model_options.h: the variants of the shading models (scene/material.h).
#pragma once

#include <cstdint>

namespace nacre {

// How the Phong family's coefficients are read.
//   kClassic: the equations as the lessons write them, without 1/pi and lobe normalisation; the
//     irradiance of a surface that faces the light takes the place of I_l.
//   kRadiometric: kd/pi, and lobes normalised so that ks is the share that they reflect of light
//     from along the normal (brdf/phong.h); comparable with the physical models under the same
//     light.
enum class PhongConvention : uint8_t { kClassic, kRadiometric };

enum class PhongModel : uint8_t {
  kPhong,          // ks (r.v)^n where n.l > 0 (Phong 1975, gated), without n.l
  kModifiedPhong,  // ks (r.v)^n n.l (Lewis 1994)
  kBlinnPhong,     // ks (n.h)^n where n.l > 0 (Blinn 1977), without n.l
};

// What replaces the light that bounces more than once between microfacets, which a
// single-scattering lobe loses: 59 % at roughness 1.
enum class Compensation : uint8_t {
  kTurquin,     // scales the lobe by what is lost towards the viewer (Turquin 2019); not reciprocal
  kKullaConty,  // adds a diffuse-like lobe (Kulla and Conty 2017); reciprocal
  kNone,        // single scattering, energy lost
};

// How much light reaches the diffuse base below the specular lobe.
enum class DiffuseCoupling : uint8_t {
  kAlbedoScaled,     // what the dielectric's albedo leaves: a white surface reflects all light
  kOneMinusFresnel,  // 1 - F(v.h), as in many lessons; a white surface may reflect 180 %
  kNone,             // all light
};

// How much light a sheen of albedo E and largest colour component m leaves to the layers below it,
// which decides whether a white surface reflects all light.
enum class SheenScaling : uint8_t {
  kReciprocal,  // 1 - m E of viewer or light, whichever is less: loses up to 14 %
  kConserving,  // 1 - m E of the viewer; not reciprocal
};

// How the reflectance of a thin film becomes three channels (brdf/thin_film.h).
enum class ThinFilmForm : uint8_t {
  kSpectral,      // Airy's sum, integrated over the spectrum
  kBelcourBarla,  // Belcour and Barla 2017, as MaterialX has it
  kLines,         // Airy's sum at 620, 540 and 450 nm
  kGltf,          // the formula of KHR_materials_iridescence; metallic-roughness alone
};

// How the diffuse base of a microfacet model reflects.
enum class DiffuseForm : uint8_t { kLambert, kOrenNayar, kBurley };

}  // namespace nacre
