// SPDX-License-Identifier: Apache-2.0
// shading/constants.h: the constants of a model that kernels read. Number is float if all hits of a
// material share them, or float* if maps give each hit of the batch its own; kernels only read
// them. Both are filled by the same functions, in derive.h.
#pragma once

#include "scene/model_options.h"

namespace nacre {

template <class Number>
struct MatteConstants {
  Number ratio[3];  // kOrenNayar: EonMultipleRatio of the colour
  Number roughness;
};

template <class Number>
struct PhongConstants {
  Number shininess;
};

// The constants of a GGX lobe over a diffuse base; see MicrofacetModel.
template <class Number>
struct MicrofacetConstants {
  // A mirror's lobe, which punctual lights cannot show, has an alpha of 1 here, and not_delta = 0.
  Number alpha, pi_over_alpha2, not_delta;
  Number schlick_k;
  // Reflectance at normal and at grazing incidence: of the mix of dielectric and metal, and of the
  // dielectric alone, which covers the base.
  Number f0[3], f90, dielectric_f0[3], dielectric_f90;
  Number metallic, metal_f0[3], f82_slope[3];  // kF82
  // kKullaConty: the scale of the second lobe, its colour, and its colour for the dielectric alone.
  Number multiple, f_multiple[3], dielectric_f_multiple[3];
  MatteConstants<Number> base;  // for bases that are not Lambertian
  // kOpenPbr: the products of share and scale of dielectric and metal, and MicrofacetModel::cover.
  Number dielectric[3], metal, cover[3];
};

// MatteLight, PhongLight and MicrofacetLight are products of a model's constants and one light.
template <class Number>
struct MatteLight {
  Number diffuse[3];  // albedo / pi * light
};

template <class Number>
struct PhongLight {
  Number diffuse[3], specular[3];  // PhongFamilyModel's constants times light
};

template <class Number>
struct MicrofacetLight {
  Number diffuse[3];   // MicrofacetModel::diffuse * light
  Number specular[3];  // light; 0 for a delta lobe, which punctual lights cannot show
  // kSchlick: products with Schlick's curve. specular_f0 and specular_rise are `specular` times F0
  // and F90 - F0. diffuse_normal and diffuse_grazing are `diffuse` times 1 - F0 and 1 - F90, which
  // the base gets at normal and at grazing incidence, or times 1 and 0 where the base is not
  // coupled to the lobe.
  Number specular_f0[3], specular_rise[3], diffuse_normal[3], diffuse_grazing[3];
  // kSchlick and kTurquin: `specular` times turquin_f0 and turquin_f90 - turquin_f0.
  Number turquin_f0[3], turquin_rise[3];
  Number multiple[3];  // kKullaConty: F_ms * light
};

}  // namespace nacre
