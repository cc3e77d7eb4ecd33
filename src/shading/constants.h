// SPDX-License-Identifier: Apache-2.0
// shading/constants.h: what the kernels read of a model. Number is float: the same for all hits of
// a material. Or it is float*: a number for each hit of the batch, where maps give it some of its
// own; kernels only read them. Both are filled by the same functions, of derive.h.
#pragma once

#include "scene/material.h"

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

// Of a GGX lobe over a diffuse base; see MicrofacetModel.
template <class Number>
struct MicrofacetConstants {
  // Of a mirror's lobe, which punctual lights cannot show, alpha counts as 1 and not_delta is 0.
  Number alpha, pi_over_alpha2, not_delta;
  Number schlick_k;
  // Reflectance at normal and at grazing incidence: of dielectric and metal mixed, and of the
  // dielectric, which covers the base.
  Number f0[3], f90, dielectric_f0[3], dielectric_f90;
  Number metallic, metal_f0[3], f82_slope[3];  // kF82
  // kKullaConty: the scale of the second lobe, its colour, and that of the dielectric's.
  Number multiple, f_multiple[3], dielectric_f_multiple[3];
  MatteConstants<Number> base;  // of bases that are not Lambert's
};

// Products of one light and a model.
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
  Number specular[3];  // light; 0 for a delta lobe, which these lights cannot show
  // kSchlick, with its curve multiplied in: `specular` times F0 and F90 - F0, what it starts from
  // and what it rises by; `diffuse` times 1 - F0 and 1 - F90, what is left at normal incidence and
  // at grazing angles, or times 1 and 0 where the base is not coupled to the lobe.
  Number specular_f0[3], specular_rise[3], diffuse_normal[3], diffuse_grazing[3];
  // kSchlick and kTurquin: `specular` times turquin_f0 and turquin_f90 - turquin_f0.
  Number turquin_f0[3], turquin_rise[3];
  Number multiple[3];  // kKullaConty: F_ms * light
};

}  // namespace nacre
